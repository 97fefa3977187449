"""Every payload on the bus, as msgspec structs: one module a domain, all of them importable from here.

SI units, radians, frame `map` unless the name says otherwise, quaternions (w, x, y, z), `t` robot time [s].
Unknown fields are ignored on receipt. Field names and strings are the wire contract.
"""

from common.messages.base import *
from common.messages.brain import *
from common.messages.household import *
from common.messages.manipulation import *
from common.messages.mapping import *
from common.messages.naming import *
from common.messages.navigation import *
from common.messages.perception import *
from common.messages.planner import *
from common.messages.process import *
from common.messages.robot import *
from common.messages.sim import *
from common.messages.speech import *
