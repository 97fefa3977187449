"""`python -m services.camera.picture FILE.png`: a picture of what was delivered, in the simulation as it is now."""

import os
import sys
from pathlib import Path

from PIL import Image

from common import topics
from common.bus import codec, delivery
from common.bus.session import BusError, default_connect, open_session
from common.rendering.renderer import Renderer, View

DELIVERY = View((0.4, 0.0, 0.5), 2.4, 215.0, -24.0)
"""The tray before the robot's home, from beside it."""
WIDTH, HEIGHT = 960, 680
"""Size of the picture [px]."""
PATIENCE = 5.0
"""Time [s] for the simulation to answer."""


def main() -> int:
    """Exit status 2 when there is nothing to take a picture of."""
    out = Path(sys.argv[1])
    try:
        connect = os.environ.get("TIDYBOT_CONNECT") or default_connect()
        with open_session(connect, os.environ.get("TIDYBOT_NAMESPACE", ""), patience=PATIENCE) as opened:
            model = delivery.fetch(opened, topics.SIM_MODEL.key, timeout=PATIENCE)
            state = delivery.fetch(opened, topics.SIM_STATE.key, timeout=PATIENCE)
    except BusError as error:
        print(f"picture: {error}", file=sys.stderr)
        return 2
    if not model or not state:
        print("picture: the simulation does not answer; see `tidybot ps`", file=sys.stderr)
        return 2
    described = codec.decode(topics.SIM_MODEL, next(iter(model.values())))
    current = codec.decode(topics.SIM_STATE, next(iter(state.values())))
    renderer = Renderer(described.mjcf, "auto", described.files)
    renderer.load(current.qpos, current.mocap)
    image = renderer.picture(DELIVERY, WIDTH, HEIGHT)
    renderer.close()
    out.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(image).save(out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
