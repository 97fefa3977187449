"""`python -m services.camera.picture --out FILE.png`: a picture of the simulation as it is now."""

import argparse
import os
import sys
from pathlib import Path

from common import topics
from common.bus import codec, delivery
from common.bus.session import BusError, default_connect, open_session
from common.rendering.renderer import Renderer, View

VIEWS = {
    "overview": View((2.0, 0.3, 0.0), 11.0, 90.0, -62.0),
    "delivery": View((0.4, 0.0, 0.5), 2.4, 215.0, -24.0),
    "robot": View((0.1, 0.0, 0.6), 2.6, 240.0, -20.0),
}


def main() -> int:
    """Exit status 2 when there is nothing to take a picture of."""
    parser = argparse.ArgumentParser(prog="python -m services.camera.picture", description=__doc__)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--view", choices=(*VIEWS, "head", "wrist"), default="overview")
    parser.add_argument("--width", type=int, default=960)
    parser.add_argument("--height", type=int, default=680)
    parser.add_argument("--backend", choices=("auto", "egl", "osmesa", "raycast"), default="auto")
    parser.add_argument("--timeout", type=float, default=5.0)
    args = parser.parse_args()
    try:
        connect = os.environ.get("TIDYBOT_CONNECT") or default_connect()
        with open_session(connect, os.environ.get("TIDYBOT_NAMESPACE", ""), patience=args.timeout) as opened:
            model = delivery.fetch(opened, topics.SIM_MODEL.key, timeout=args.timeout)
            state = delivery.fetch(opened, topics.SIM_STATE.key, timeout=args.timeout)
    except BusError as error:
        print(f"picture: {error}", file=sys.stderr)
        return 2
    if not model or not state:
        print("picture: the simulation does not answer; see `tidybot ps`", file=sys.stderr)
        return 2
    described = codec.decode(topics.SIM_MODEL, next(iter(model.values())))
    current = codec.decode(topics.SIM_STATE, next(iter(state.values())))
    renderer = Renderer(described.mjcf, args.backend, described.files)
    renderer.load(current.qpos, current.mocap)
    if args.view in VIEWS:
        image = renderer.picture(VIEWS[args.view], args.width, args.height)
    else:
        image = renderer.rgbd(args.view, args.width, args.height)[0]
    renderer.close()
    from PIL import Image

    args.out.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(image).save(args.out)
    print(f"{args.out} ({renderer.backend})")
    return 0


if __name__ == "__main__":
    sys.exit(main())
