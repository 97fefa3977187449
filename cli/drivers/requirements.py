"""What `tidybot conform` asks of a driver, one function for each requirement; the docstring is the requirement."""

import math
from typing import Any

import numpy as np

from cli.drivers.driver import PERIOD, Driver, Unmet
from common import messages as m
from common import topics
from common.robot.joints import ARM, JOINTS
from common.topic import Topic

STEP, SPEED = 0.15, 0.12
"""Length of a commanded move [m] and speed [m/s]; chosen: small enough for a room that nobody cleared."""
SILENT, REST = 0.9, 0.01
"""Time [s] without a command after which the base must rest, and the speed [m/s] that counts as rest."""
STOP_WITHIN = 0.5
"""Time [s] from `robot/stop` to rest."""


# --- what it says by itself
def token(driver: Driver) -> None:
    """Shows the token service/sim/alive."""
    if "sim" not in driver.link.alive():
        raise Unmet("no liveliness token service/sim/alive")


def joint_states(driver: Driver) -> None:
    """joint_states at 100 Hz with the robot's joints, finite, its time rising."""
    rows = driver.heard[topics.JOINT_STATES.key]
    if len(rows) < 10:
        raise Unmet(driver.bad.get(topics.JOINT_STATES.key) or f"{len(rows)} messages")
    missing = [name for name in JOINTS if name not in rows[-1].name]
    if missing:
        raise Unmet(f"joints missing: {', '.join(missing)}")
    for row in rows:
        sizes = {len(row.name), len(row.position), len(row.velocity), len(row.effort)}
        if len(sizes) != 1 or not np.isfinite([*row.position, *row.velocity, *row.effort]).all():
            raise Unmet("name, position, velocity and effort must be equally long and finite")
    _rate([row.t for row in rows], topics.JOINT_STATES.rate)


def odometry(driver: Driver) -> None:
    """base/odom at 100 Hz that agrees with joint_states."""
    rows = driver.heard[topics.ODOMETRY.key]
    _rate([row.t for row in rows], topics.ODOMETRY.rate)
    x, y, _ = driver.place()
    if math.hypot(rows[-1].x - x, rows[-1].y - y) > 0.02:
        raise Unmet(f"odometry ({rows[-1].x:.3f}, {rows[-1].y:.3f}), joint_states ({x:.3f}, {y:.3f})")


def scan(driver: Driver) -> None:
    """scan at 10 Hz, float32 ranges all around."""
    rows = driver.heard[topics.SCAN.key]
    _rate([row.t for row in rows], topics.SCAN.rate)
    last = rows[-1]
    if len(last.ranges) % 4:
        raise Unmet(f"ranges of {len(last.ranges)} bytes are no float32 values")
    ranges = np.frombuffer(last.ranges, "<f4")
    around = len(ranges) * last.angle_increment
    if abs(around - 2 * math.pi) > 0.2:
        raise Unmet(f"{len(ranges)} rays cover {math.degrees(around):.0f} degrees; costmap and localisation need 360")
    if not np.isfinite(ranges).all() or (ranges < 0).any():
        raise Unmet("ranges must be finite and not negative; above range_max means that nothing was seen")


def description(driver: Driver) -> None:
    """robot/description (latched): MJCF of arm and gripper, with the carry pose as keyframe `home`."""
    found = driver.link.latest(topics.ROBOT_DESCRIPTION)
    if found is None:
        raise Unmet("nobody answers a get")
    if lacks := missing_in(found.mjcf):
        raise Unmet(lacks)


def missing_in(mjcf: str) -> str:
    """What a description lacks for inverse kinematics, collision checks and masks in pictures; "" if nothing."""
    import mujoco

    from common.robot.model import HOME, SIDES, Hand, pads

    try:
        model = mujoco.MjModel.from_xml_string(mjcf)
    except ValueError as error:
        return f"MuJoCo cannot read it: {error}"
    kinds = mujoco.mjtObj
    wanted = [(kinds.mjOBJ_JOINT, "joint", name) for name in ARM]
    wanted += [(kinds.mjOBJ_BODY, "body", "base"), (kinds.mjOBJ_BODY, "body", "gripper")]
    wanted += [(kinds.mjOBJ_SITE, "site", "pinch"), (kinds.mjOBJ_KEY, "keyframe", HOME)]
    missing = [f"{what} {name}" for kind, what, name in wanted if mujoco.mj_name2id(model, kind, name) < 0]
    missing += [f"geom {side}_pad" for side, found in zip(SIDES, pads(model), strict=True) if not found]
    try:
        Hand(model)
    except (KeyError, ValueError):
        missing.append("joints left_finger and right_finger")
    return f"missing: {', '.join(missing)}" if missing else ""


def latched(driver: Driver) -> None:
    """base/goal_reached and sim/status answer a get."""
    both: tuple[Topic[Any], ...] = (topics.GOAL_REACHED, topics.SIM_STATUS)
    for topic in both:
        if driver.link.latest(topic) is None:
            raise Unmet(f"nobody answers a get on {topic.key}")


def _rate(stamps: list[float], declared: float) -> None:
    if len(stamps) < 3:
        raise Unmet(f"{len(stamps)} messages")
    steps = np.diff(stamps)
    if (steps <= 0).any():
        raise Unmet("its time `t` must rise with each message")
    rate = 1.0 / float(np.median(steps))
    if not 0.8 * declared <= rate <= 1.25 * declared:
        raise Unmet(f"{rate:.0f} Hz, {declared:.0f} are declared")


# --- what it does when it is told to
def target(driver: Driver) -> None:
    """base/target_pose: drives there and says so with the target's id."""
    x, y, yaw = driver.place()
    there = (x + STEP * math.cos(yaw), y + STEP * math.sin(yaw))
    for name, (tx, ty) in (("there", there), ("back", (x, y))):
        identity = f"conform-{name}"
        driver.link.send(topics.BASE_TARGET, m.BaseTarget(x=tx, y=ty, theta=yaw, id=identity))

        def reached(identity: str = identity) -> bool:
            rows = driver.heard[topics.GOAL_REACHED.key]
            return any(row.reached and row.target_id == identity for row in rows)

        if not driver.wait(8.0, reached):
            raise Unmet(f"no goal_reached with target_id {identity!r} within 8 s")
        now = driver.place()
        if math.hypot(now[0] - tx, now[1] - ty) > 0.05:
            raise Unmet(f"claims to be {name}, but is {math.hypot(now[0] - tx, now[1] - ty):.2f} m away")


def velocity(driver: Driver) -> None:
    """base/cmd_vel: follows the stream in the robot's frame; comes to rest when it falls silent."""
    for way in (1, -1):
        before = driver.place()
        driver.wait(1.5, each=lambda way=way: _drive(driver, way * SPEED))  # type: ignore[misc]
        x, y, _ = driver.place()
        ahead = way * ((x - before[0]) * math.cos(before[2]) + (y - before[1]) * math.sin(before[2]))
        if ahead < 0.3 * SPEED * 1.5:
            raise Unmet(f"{ahead:.3f} m after 1.5 s at {SPEED} m/s")
        driver.wait(SILENT)
        if driver.speed() > REST:
            raise Unmet(f"still {driver.speed():.3f} m/s {SILENT} s after the last command")


def _drive(driver: Driver, vx: float) -> None:
    driver.link.send(topics.CMD_VEL, m.CmdVel(vx=vx, vy=0.0, omega=0.0))


def arm(driver: Driver) -> None:
    """arm/command: follows a stream of set-points, holds when it falls silent, refuses what it cannot do."""
    start = driver.joints()
    angles = [start[name] for name in ARM]
    for goal in (angles[6] + 0.2, angles[6]):
        begin, now = driver.t, driver.joints()["joint_7"]

        def along(begin: float = begin, now: float = now, goal: float = goal) -> None:
            share = min(1.0, (driver.t - begin) / 1.0)
            position = [*angles[:6], now + share * (goal - now)]
            driver.link.send(topics.ARM_COMMAND, m.ArmCommand(position=position, period=PERIOD, t=driver.t))

        driver.wait(1.3, each=along)
        driver.wait(0.7)
        if abs(driver.joints()["joint_7"] - goal) > 0.05:
            raise Unmet(f"joint_7 is {abs(driver.joints()['joint_7'] - goal):.3f} rad from its set-point")
    driver.link.send(topics.ARM_COMMAND, m.ArmCommand(position=[math.nan] * 7))
    driver.link.send(topics.ARM_COMMAND, m.ArmCommand(position=[0.0] * 3))
    driver.wait(0.5)
    worst = max(abs(driver.joints()[name] - start[name]) for name in ARM)
    if worst > 0.05:
        raise Unmet(f"moved by {worst:.2f} rad for a set-point that is none")


def gripper(driver: Driver) -> None:
    """gripper_command: closes and opens; joint_states tell the width in metres."""
    for position, low, high in ((1.0, -0.002, 0.015), (0.0, 0.06, 0.2)):
        driver.link.send(topics.GRIPPER_COMMAND, m.GripperCommand(position=position))
        if not driver.wait(4.0, lambda low=low, high=high: low <= driver.joints()["gripper"] <= high):  # type: ignore[misc]
            raise Unmet(f"width {driver.joints()['gripper']:.3f} m four seconds after position {position:g}")


def stop(driver: Driver) -> None:
    """robot/stop: brakes, says so, ignores commands until robot/resume."""
    driver.wait(1.0, each=lambda: _drive(driver, SPEED))
    try:
        driver.link.send(topics.ROBOT_STOP, m.RobotStop(reason="tidybot conform", source="conform"))
        if not driver.wait(STOP_WITHIN, lambda: driver.speed() < REST, each=lambda: _drive(driver, SPEED)):
            raise Unmet(f"still {driver.speed():.3f} m/s {STOP_WITHIN} s after robot/stop")
        held = driver.place()
        driver.wait(1.0, each=lambda: _drive(driver, SPEED))
        if math.dist(held[:2], driver.place()[:2]) > 0.02:
            raise Unmet("obeys base/cmd_vel while stopped")
        status = driver.link.latest(topics.SIM_STATUS)
        if status is None or status.state != "stopped":
            raise Unmet(f"sim/status says {status.state if status else 'nothing'}, not stopped")
    finally:
        driver.link.send(topics.ROBOT_RESUME, m.RobotResume(source="conform"))
    driver.wait(1.5, each=lambda: _drive(driver, -SPEED))
    if math.dist(held[:2], driver.place()[:2]) < 0.03:
        raise Unmet("does not move after robot/resume")
    driver.wait(SILENT)


def nonsense(driver: Driver) -> None:
    """Lives through payloads that are none, and does not move for them."""
    before = driver.place()
    for topic in (topics.BASE_TARGET, topics.CMD_VEL, topics.ARM_COMMAND, topics.GRIPPER_COMMAND):
        for payload in (b"", b"\xff\xfe", b"{}", b'{"x": "a"}'):
            driver.link.session.put(topic.key, payload)
    driver.link.send(topics.BASE_TARGET, m.BaseTarget(x=math.inf, y=0.0, theta=0.0, id="nowhere"))
    driver.wait(1.0)
    if math.dist(before[:2], driver.place()[:2]) > 0.02:
        raise Unmet(f"moved {math.dist(before[:2], driver.place()[:2]):.3f} m")


LISTENING = (token, joint_states, odometry, scan, description, latched)
MOVING = (target, velocity, arm, gripper, stop, nonsense)
