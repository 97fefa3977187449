"""A policy that grabs: how it is found, what it sees, and what of its answers is an action."""

import pkgutil
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from common import messages as m
from common.demonstration import ACTION, PICTURE_SIZE, STATE
from common.geometry import Array

Observation = dict[str, Any]
Policy = Callable[[Observation], Any]
MAX_AGE = 1.0
"""Age [s] up to which a picture is shown to a policy; chosen: ten times the period at which the camera draws."""


class PolicyError(ValueError):
    """There is no such policy, or it has answered something that is no action; says what."""


class Action(NamedTuple):
    """Targets (7,) [rad] of the joints, and how far the gripper is to be closed, 0 to 1."""

    joints: Array
    closed: float


def load_policy(entry: str) -> Callable[[], Policy]:
    """Makes a policy for each episode: of a class an instance, of any other callable itself.

    Raises:
        PolicyError: it cannot be imported or called.
    """
    try:
        found = pkgutil.resolve_name(entry)
    except (ImportError, AttributeError, ValueError) as error:
        raise PolicyError(f"{entry}: {error}; expected package.module:name that can be imported") from None
    if not callable(found):
        raise PolicyError(f"{entry} is {type(found).__name__} and cannot be called")
    return found if isinstance(found, type) else lambda: found


def guarded(fn: Callable[..., Any], *args: Any) -> Any:
    """What code that is not ours answers.

    Raises:
        PolicyError: it has raised, whatever it was.
    """
    try:
        return fn(*args)
    except Exception as error:
        raise PolicyError(f"{type(error).__name__}: {error}") from error


def act(policy: Policy, seen: Observation) -> Action | None:
    """The policy's action for what it sees, None when it is done.

    Raises:
        PolicyError: it has raised, or answered what is no action.
    """
    return action_of(guarded(policy, seen))


def state_of(joints: m.JointStates) -> Array | None:
    """`observation.state` (11,) float32 as demonstrations have it; None where a joint is missing."""
    position = dict(zip(joints.name, joints.position, strict=False))
    if not set(STATE) <= position.keys():
        return None
    return np.array([position[name] for name in STATE], np.float32)


def picture_of(message: m.Rgbd) -> np.ndarray[Any, Any] | None:
    """`observation.images.*` uint8 (240, 320, 3); None for a picture of another size."""
    width, height = PICTURE_SIZE
    if (message.width, message.height) != (width, height) or len(message.rgb) != width * height * 3:
        return None
    return np.frombuffer(message.rgb, np.uint8).reshape(height, width, 3)


def observation(
    state: Array, pictures: Mapping[str, Any], task: str, more: Mapping[str, Any] | None = None
) -> Observation:
    """What a policy is called with: a frame of a demonstration without its action, and `more` that this robot knows."""
    seen = {f"observation.images.{name}": picture for name, picture in pictures.items()}
    return {"observation.state": state, **seen, "task": task, **(more or {})}


def action_of(answer: object) -> Action | None:
    """The action of an answer, None for a policy that says it is done.

    The base's part is not played: navigation has brought the robot to where it stands.

    Raises:
        PolicyError: not 11 finite numbers.
    """
    if answer is None:
        return None
    try:
        values = np.asarray(answer, np.float64).reshape(-1)
    except (TypeError, ValueError) as error:
        raise PolicyError(f"answered {type(answer).__name__}: {error}") from None
    if values.shape != (len(ACTION),) or not np.isfinite(values).all():
        raise PolicyError(f"answered {values.size} numbers, {int(np.isfinite(values).sum())} finite; {len(ACTION)} do")
    return Action(values[3:10], float(np.clip(values[10], 0.0, 1.0)))
