"""The tests; what they need of the environment is set before any of them imports anything."""

import os

from common.rendering.backend import best, environment

# Keys in the developer's own `run/` have no part in the tests.
os.environ["TIDYBOT_KEYS"] = "off"
# What tests import brings MuJoCo along before their camera could choose, and would cast every picture.
if not os.environ.get("MUJOCO_GL"):
    os.environ |= environment(best())
