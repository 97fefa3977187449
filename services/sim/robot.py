"""Groups and constants of the robot whose model is `robots/tidybot.xml`."""

from pathlib import Path

from common.rendering.looks import HIDDEN_GROUP

MODEL = Path(__file__).parent / "robots" / "tidybot.xml"
GLASS_GROUP = 2
"""Geoms that the lidar's light goes through."""
ROBOT_GROUP = 3
"""Geoms of the robot itself, which its own lidar does not see."""
MAST = ("mast", "mast_arm", "head")
"""Geoms that carry the head camera, on a corner of the base where the elbow does not come; Stanford's has them not."""
HULL_GROUP = HIDDEN_GROUP
"""Geoms that collide but are not to be seen, for bodies with meshes to look at; nobody draws this group."""
POST = "post_"
"""How the names of the geoms begin that stand in the lidar's slot."""
