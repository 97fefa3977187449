"""Cameras, perception and the objects it knows."""

from typing import Literal

from common.messages.base import IDENTITY, Message, Quat, Vec3

ShapeFamily = Literal["", "round", "box", "bowl", "ball", "long", "irregular"]
"""The family of a measured shape: turned about its axis, box, open vessel, ball, longer than wide, none of these."""
End = Literal["open", "closed", ""]
"""What an end of an object was seen to be, \"\" when too little tells."""


class ObjectRef(Message):
    """What manipulation is told about the object to grab: `position` is its centre, `size` full extent.

    `tilt`, `shape` and `points` as in `WorldObject`.
    """

    label: str
    position: Vec3
    orientation: Quat = IDENTITY
    size: Vec3 = (0.0, 0.0, 0.0)
    kind: str = ""
    frame: str = "map"
    tilt: float = 0.0
    shape: ShapeFamily = ""
    points: bytes = b""


class WorldObject(Message):
    """An object the robot knows of. `on` names its receptacle, `seen_at` is the time of the evidence.

    `tilt` [rad]: angle of its own upward axis to the vertical, 0 when it stands. Of what lies on its side, the first
    extent of `size` is along that axis, which points along the yaw of `orientation`.

    `label` is unique in one list: what looks alike is "red mug" and "red mug 2". `names`: what it is called beside its
    label, as taught by a person; `text`: what was read on it; `colours`: the words of its colours, the largest first;
    `kinds`: what it may be by its looks, the likeliest first. `kind_shares`, `colour_shares`: how likely each kind is
    and how much of it has each colour, each adding up to 1; empty where nothing was measured. `measured`: `size` was
    measured and not looked up in the household; `spread`: standard deviation [m] of its extents and position.
    `points`: what was seen of its surface, int16 (n, 3) [mm], little endian, in map axes from `position`.
    `top`: what its upper end is, of what lies the one that is to be above.
    """

    label: str
    kind: str
    colour: str
    position: Vec3
    orientation: Quat = IDENTITY
    size: Vec3 = (0.0, 0.0, 0.0)
    on: str = ""
    confidence: float = 1.0
    seen_at: float = 0.0
    held: bool = False
    id: str = ""
    tilt: float = 0.0
    shape: ShapeFamily = ""
    names: list[str] = []
    text: str = ""
    colours: list[str] = []
    kinds: list[str] = []
    kind_shares: dict[str, float] = {}
    colour_shares: dict[str, float] = {}
    measured: bool = False
    spread: float = 0.0
    points: bytes = b""
    top: End = ""


class WorldObjects(Message):
    t: float
    objects: list[WorldObject]
    source: str = "survey"


class ObjectQuery(Message):
    """`since` [s]: only what a picture taken at that robot time or later shows counts, and the picture is wanted.

    `meant`: id of the object that is meant as long as it is there, since the person said so or it was found for these
    words before; `excluded`: ids of objects that the person said are not.
    """

    id: str
    query: str
    since: float = 0.0
    meant: str = ""
    excluded: list[str] = []


class PossibleObject(Message):
    """An object, by its id, that words may mean and do not plainly; `likeness` 0 to 1: how well they fit it."""

    id: str
    label: str
    likeness: float
    position: Vec3
    on: str = ""


class ObjectPose(Message):
    """The answer to a query. `candidates` names the objects that match when several do and none is chosen.

    `id` is the object's in `WorldObject`. `perhaps`: objects that may be meant, the likeliest first, for the person to
    say; nothing that is `found` is among them. `unsure`: labels of objects that may be meant and can be told from
    nearer or from another side, the likeliest first; `unlikely`: others of which that is not expected.
    `seen_at`: when a picture last showed the object; `on` names its receptacle, "" the floor or not known; `tilt` as
    in `WorldObject`. `picture`: a JPEG of the view behind the answer, for queries with `since`.
    """

    query_id: str
    found: bool
    label: str = ""
    confidence: float = 0.0
    frame: str = "map"
    position: Vec3 = (0.0, 0.0, 0.0)
    orientation: Quat = IDENTITY
    size: Vec3 = (0.0, 0.0, 0.0)
    seen_at: float = 0.0
    detail: str = ""
    candidates: list[str] = []
    unsure: list[str] = []
    unlikely: list[str] = []
    perhaps: list[PossibleObject] = []
    id: str = ""
    on: str = ""
    tilt: float = 0.0
    picture: bytes = b""


CameraName = Literal["head", "wrist"]


class CameraRequest(Message):
    id: str
    camera: CameraName
    width: int = 320
    height: int = 240


class Rgbd(Message):
    """One RGB-D image: rgb uint8 h*w*3, depth uint16 [mm] h*w (0: nothing seen).

    `position`, `orientation`: pose of the optical frame (x right, y down, z forward) in the base frame,
    by the camera's drawing or, if it is `calibrated`, by the calibration.
    """

    t: float
    id: str
    camera: str
    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    position: Vec3
    orientation: Quat
    rgb: bytes
    depth: bytes
    backend: str = ""
    calibrated: bool = False
