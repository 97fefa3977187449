"""The viewpoint planner, and the order in which the brain's search goes through its viewpoints."""

import math

import msgspec
import mujoco
import numpy as np
import pytest

from common import messages as m
from common.floor_plan import Box, FloorPlan, Place, Receptacle, Wall
from common.geometry import Pose2
from common.household import Household, load_household
from common.viewpoints import NEAR, NOMINAL, REACH, Viewpoints, viewpoints_of
from common.whereabouts import LEAST, spread
from services.brain.world import viewpoint_search
from services.brain.world.floor_views import floor_views
from services.sim.unit import head_camera

SCENE = load_household("apartment")
HOME = (0.0, 0.0, 0.0)
VIEWPOINTS = viewpoints_of(SCENE, None)


def test_the_search_shows_every_surface_and_ends() -> None:
    looked_from: list[Pose2] = []
    at: Pose2 = HOME
    while (view := viewpoint_search.elsewhere(SCENE, VIEWPOINTS, at, looked_from)) is not None:
        assert view not in looked_from
        assert (VIEWPOINTS.visible(view) & ~VIEWPOINTS.covered(looked_from)).sum() > 2, "worth the way"
        looked_from.append(view)
        at = view
    assert len(looked_from) < 20
    assert VIEWPOINTS.covered(looked_from).mean() > 0.97


def test_what_may_lie_flat_is_looked_for_from_near_in_the_end_and_where_it_is_told_to_be_first() -> None:
    looked_from: list[Pose2] = []
    while (view := viewpoint_search.elsewhere(SCENE, VIEWPOINTS, HOME, looked_from, near=True)) is not None:
        looked_from.append(view)
    assert VIEWPOINTS.covered(looked_from, NEAR)[VIEWPOINTS.listed].mean() > 0.9
    told = VIEWPOINTS.surface == VIEWPOINTS.surface[0]
    far: list[Pose2] = []
    while (view := viewpoint_search.there(SCENE, VIEWPOINTS, HOME, far, (), told, near=True)) is not None:
        assert VIEWPOINTS.visible(view)[told].any()
        far.append(view)
    assert VIEWPOINTS.covered(far, NEAR)[told].mean() > 0.9
    assert viewpoint_search.elsewhere(SCENE, VIEWPOINTS, HOME, looked_from) is None
    assert len(far) < len(looked_from) / 4


def test_what_is_told_to_lie_on_the_floor_is_looked_for_all_over_it() -> None:
    study = next(room for room in SCENE.rooms if room.name == "study")
    floor, none = floor_views(VIEWPOINTS, (study,)), np.zeros(len(VIEWPOINTS.points), bool)
    assert all(study.outline.contains(x, y) and SCENE.surface_at(x, y) is None for x, y, _ in floor.points.tolist())
    looked_from: list[Pose2] = []
    while (view := viewpoint_search.there(SCENE, VIEWPOINTS, HOME, looked_from, (), none, floor)) is not None:
        assert floor.visible(view).any()
        looked_from.append(view)
    assert floor.covered(looked_from).mean() > 0.95 and len(looked_from) < 8


def test_every_view_shows_something_new() -> None:
    first = viewpoint_search.elsewhere(SCENE, VIEWPOINTS, HOME, [])
    assert first is not None
    second = viewpoint_search.elsewhere(SCENE, VIEWPOINTS, first, [first])
    assert second is not None
    assert VIEWPOINTS.covered([first, second]).sum() > VIEWPOINTS.covered([first]).sum() > 0


def test_what_a_view_would_have_shown_that_was_not_reached_is_looked_at_from_another() -> None:
    first = viewpoint_search.elsewhere(SCENE, VIEWPOINTS, HOME, [])
    assert first is not None
    looked_from: list[Pose2] = []
    while (view := viewpoint_search.elsewhere(SCENE, VIEWPOINTS, HOME, looked_from, [first])) not in (first, None):
        looked_from.append(view)
    assert (VIEWPOINTS.visible(first) & VIEWPOINTS.covered(looked_from)).any()
    missed = (VIEWPOINTS.visible(first) & ~VIEWPOINTS.covered(looked_from)).any()
    assert view == (first if missed else None), "the last of all, once more"
    for times in (2, 5):
        assert viewpoint_search.elsewhere(SCENE, VIEWPOINTS, HOME, looked_from, [first] * times) is None


def test_turning_stays_on_the_spot_and_ends() -> None:
    pose: Pose2 = (0.9, -1.4, 0.0)
    looked_from: list[Pose2] = []
    while (view := viewpoint_search.turn(VIEWPOINTS, pose, looked_from)) is not None:
        assert view[:2] == pose[:2]
        looked_from.append(view)
    assert 1 <= len(looked_from) <= 12


def test_walls_hide_what_is_behind_them() -> None:
    alone = SCENE.receptacle("study shelf")
    assert alone is not None
    # From the living room the shelf is 2.4 m away, behind the wall between.
    hidden = Viewpoints(msgspec.structs.replace(SCENE, receptacles=(alone,)), NOMINAL)
    assert not hidden.covered([(1.3, 1.9, math.pi / 2)]).any()
    assert hidden.covered([(1.3, 2.6, math.pi / 2)]).any()


def test_views_do_not_look_through_walls_or_beyond_the_picture() -> None:
    views = VIEWPOINTS
    table = np.hypot(*(views.points[:, :2] - (5.3, -0.75)).T) < 0.2
    assert table.any()
    assert views.visible((4.2, -0.75, 0.0))[table].all()
    assert not views.visible((4.2, -0.75, math.pi))[table].any(), "behind it"
    assert not views.visible((2.0, -2.0, 0.8))[table].any(), "in the next room"
    shelf = np.hypot(*(views.points[:, :2] - (1.45, 1.74)).T) < 0.3
    assert not views.visible((1.45, 3.0, -math.pi / 2))[shelf].any(), "behind the wall"


def test_a_camera_that_looks_aside_sees_what_is_there() -> None:
    left = msgspec.structs.replace(NOMINAL, yaw=math.pi / 2)
    aside = viewpoints_of(SCENE, m.RobotDescription(mjcf="", head_camera=left))
    # Its optical centre is behind the base's: the base stands so that the camera is and looks where the other does.
    x, y = 4.2 + NOMINAL.x, -0.75 + NOMINAL.x
    assert (aside.visible((x, y, -math.pi / 2)) == VIEWPOINTS.visible((4.2, -0.75, 0.0))).all()


def test_a_higher_camera_looks_over_more() -> None:
    low, high = (msgspec.structs.replace(NOMINAL, z=z) for z in (0.9, 1.6))
    shown = [Viewpoints(SCENE, camera).shows.any(axis=0).mean() for camera in (low, high)]
    assert shown[0] < shown[1]


@pytest.mark.parametrize("orientation", ['xyaxes="0 -1 0 0.5 0 0.866"', 'euler="0 -60 -90"'])
def test_the_mount_is_read_from_the_model(orientation: str) -> None:
    camera = f'<camera name="head" pos="-0.1 0.05 1.2" {orientation} fovy="50"/>'
    text = f'<mujoco><worldbody><body name="base"><geom size="0.1" mass="1"/>{camera}</body></worldbody></mujoco>'
    mount = head_camera(mujoco.MjModel.from_xml_string(text))
    assert mount is not None
    assert np.allclose((mount.x, mount.y, mount.z), (-0.1, 0.05, 1.2))
    assert math.isclose(mount.pitch, math.radians(30), abs_tol=1e-3)
    assert math.isclose(mount.yaw, 0.0, abs_tol=1e-6) and math.isclose(mount.fovy, math.radians(50))


def test_a_robot_without_the_camera_has_no_mount() -> None:
    body = '<body name="base"><geom size="0.1" mass="1"/></body>'
    assert head_camera(mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{body}</worldbody></mujoco>")) is None


def test_nothing_beyond_the_camera_s_reach_is_shown() -> None:
    for pose, shows in zip(VIEWPOINTS.poses, VIEWPOINTS.shows, strict=True):
        eye = (pose[0] + NOMINAL.x * math.cos(pose[2]), pose[1] + NOMINAL.x * math.sin(pose[2]))
        assert shows.any()
        assert np.hypot(*(VIEWPOINTS.points[shows, :2] - eye).T).max() < REACH


def test_where_there_is_little_room_it_looks_last_and_where_no_way_leads_never() -> None:
    """A room of 4 x 4 m with a table, a desk in a gangway of 0.85 m, and a closet without a door with a shelf."""

    def surface(name: str, x: float, y: float, side: tuple[float, float]) -> Receptacle:
        return Receptacle(name=name, kind="table", center=(x, y, 0.75), size=(0.8, 0.6), approach=(side,))

    flat = FloorPlan(
        name="flat", low=(0.0, 0.0), high=(6.0, 4.0), home=Place(name="home", x=1.0, y=2.0),
        walls=(Wall(start=(4.0, 0.0), end=(4.0, 4.0)),),
        furniture=(Box(name="wardrobe", center=(2.9, 1.75, 1.0), size=(1.6, 0.6, 2.0)),),
        receptacles=(
            surface("table", 0.5, 3.6, (0.0, -1.0)), surface("desk", 2.9, 0.3, (0.0, 1.0)),
            surface("shelf", 5.0, 0.4, (0.0, 1.0)),
        ),
    )  # fmt: skip
    views = Viewpoints(flat, NOMINAL)
    shown = [views.surface == n for n in range(3)]
    looked_from: list[Pose2] = []
    while (view := viewpoint_search.elsewhere(flat, views, (1.0, 2.0, 0.0), looked_from)) is not None:
        looked_from.append(view)
        if len(looked_from) == 1:
            assert views.visible(view)[shown[0]].any() and not views.visible(view)[shown[1]].any()
    covered = views.covered(looked_from)
    assert covered[shown[1]].mean() > 0.9, "the desk is looked at from the gangway"
    assert not covered[shown[2]].any()


@pytest.mark.parametrize(("start", "sofa_first"), [((1.0, 2.5, 0.0), True), ((4.0, 1.5, 0.0), False)])
def test_sofas_and_beds_are_looked_at_on_the_way(start: Pose2, sofa_first: bool) -> None:
    sofa = Box(name="sofa seat", center=(1.0, 3.5, 0.21), size=(1.6, 0.8, 0.42))
    flat = Household(
        name="flat", low=(0.0, 0.0), high=(6.0, 4.0), home=Place(name="home", x=1.5, y=2.0),
        walls=(Wall(start=(0.0, 4.0), end=(6.0, 4.0)),),
        furniture=(
            sofa, Box(name="sofa back", center=(1.0, 3.85, 0.6), size=(1.6, 0.16, 0.4)),
            Box(name="chest", center=(5.5, 3.6, 0.5), size=(0.6, 0.6, 1.0)),
            Box(name="rug", center=(2.0, 1.0, 0.005), size=(1.0, 1.0, 0.01)),
        ),
        receptacles=(
            Receptacle(name="table", kind="table", center=(5.0, 0.4, 0.5), size=(1.0, 0.6), approach=((0.0, 1.0),)),
        ),
    )  # fmt: skip
    views = Viewpoints(flat, NOMINAL)
    assert set(views.surface) == {0, 1}, "no chest, no rug"
    on_sofa = views.surface == 1
    assert views.points[on_sofa][:, 2].max() < 0.5 and all(sofa.outline.contains(*p[:2]) for p in views.points[on_sofa])
    likely = spread({"table": 1.0}, flat, views)
    assert likely[on_sofa].max() == LEAST and likely[~on_sofa].mean() == pytest.approx(1.0)
    looked_from: list[Pose2] = []
    while (view := viewpoint_search.elsewhere(flat, views, start, looked_from, (), likely)) is not None:
        looked_from.append(view)
        start = view
    assert bool(views.visible(looked_from[0])[on_sofa].any()) is sofa_first
    assert views.covered(looked_from)[on_sofa].mean() > 0.9


def test_a_shelf_beside_the_robot_is_not_passed_by_and_come_back_to() -> None:
    def surface(name: str, x: float, length: float) -> Receptacle:
        return Receptacle(name=name, kind="table", center=(x, 3.6, 0.6), size=(length, 0.6), approach=((0.0, -1.0),))

    flat = Household(
        name="flat", low=(-1.0, 0.0), high=(10.0, 4.0), home=Place(name="home", x=0.5, y=2.0),
        receptacles=(surface("shelf", 0.0, 0.5), surface("table", 4.0, 1.6), surface("desk", 9.0, 1.6)),
    )  # fmt: skip
    views = Viewpoints(flat, NOMINAL)
    first = viewpoint_search.elsewhere(flat, views, (0.5, 2.0, -1.57), [])
    assert first is not None
    assert views.visible(first)[views.surface == 0].any()


def test_what_shows_from_no_pose_before_it_is_looked_at_from_where_there_is_floor() -> None:
    """A passage before a dresser that is wide enough for the robot, and too narrow for the usual distances."""
    flat = FloorPlan(
        name="flat", low=(0.0, 0.0), high=(4.0, 4.0), home=Place(name="home", x=0.6, y=3.0),
        furniture=(Box(name="bed", center=(2.0, 1.65, 0.35), size=(1.8, 1.0, 0.7)),),
        receptacles=(
            Receptacle(name="dresser", kind="counter", center=(2.0, 0.2, 0.8), size=(1.0, 0.4), approach=((0.0, 1.0),)),
        ),
    )  # fmt: skip
    views, looked_from = Viewpoints(flat, NOMINAL), list[Pose2]()
    while (view := viewpoint_search.elsewhere(flat, views, (0.6, 3.0, 0.0), looked_from)) is not None:
        looked_from.append(view)
    assert views.covered(looked_from).mean() > 0.9
