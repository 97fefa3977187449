"""The one table of processes that make up the robot. A new service is one line here."""

import msgspec


class Service(msgspec.Struct, frozen=True):
    """A process `python -m <module>`. `paced`: follows the simulation in lockstep. `token`: shows itself on the bus.
    `needs`: off by default, and of the extra of its name, whose
    package that is."""

    name: str
    module: str
    paced: bool = True
    token: bool = True
    needs: str = ""


SERVICES = (
    Service("router", "services.router", paced=False, token=False),
    Service("sim", "services.sim", paced=False),
    Service("camera", "services.camera"),
    Service("navigation", "services.navigation"),
    Service("mapping", "services.mapping", needs="gtsam"),
    Service("manipulation", "services.manipulation"),
    Service("speech", "services.speech"),
    Service("planner", "services.planner"),
    Service("perception", "services.perception"),
    Service("brain", "services.brain"),
    Service("dashboard", "services.dashboard", paced=False),
    Service("ros2", "services.ros2", paced=False, needs="rosbags"),
    Service("foxglove", "services.foxglove", paced=False, needs="foxglove"),
)
NAMES = tuple(s.name for s in SERVICES)
OPTIONAL = tuple(s.name for s in SERVICES if s.needs)
SECTIONS = ("runtime", *(n for n in NAMES if n != "router"))
