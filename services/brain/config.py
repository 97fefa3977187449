"""Parameters of the brain (`config/brain.toml`)."""

from typing import Literal

from common.config import Config


class BrainConfig(Config, frozen=True):
    """Times in seconds of robot time; a limit of n retries means n + 1 tries."""

    pipeline: Literal["fetch", "vla"] = "vla"
    """`vla`: confirm, plan, ground, navigate, act; `fetch`: the eight-state flow."""
    enable_confirmation: bool = True
    """`vla` asks "Did you say ...?" before a mission starts."""
    max_retry_attempts: int = 3
    """`vla`: plans, searches and rounds of confirmation before it gives up [count]; fixed by the contract."""
    confirm_below: float = 0.8
    """Confidence of what was heard below which it asks also without `enable_confirmation`, 0 to 1."""
    settle: float = 1.0
    """Rest after every arrival and every finished manipulation; fixed by the contract."""
    speech_retry_delay: float = 5.0
    """Rest before it listens again after a failure of speech."""
    heartbeat_patience: float = 60.0
    """How long a mission waits for `joint_states` that stay away, before it ends in ERROR: ten times what a killed
    simulation needs to come back on a busy machine."""
    listen_timeout: float = 60.0
    """Time for a command to be heard."""
    listen_grace: float = 1.0
    """Added to `listen_timeout`: the speech service's own limit may come first."""
    answer_timeout: float = 15.0
    """Time for yes, no or a correction."""
    navigation_timeout: float = 180.0
    """Time for a navigation goal."""
    manipulation_timeout: float = 120.0
    """Time for a manipulation goal."""
    planning_timeout: float = 30.0
    """Time for a plan."""
    perception_timeout: float = 10.0
    """Time for perception to answer."""
    peer_timeout: float = 30.0
    """How long a goal waits for a service that is not running."""
    say_timeout: float = 15.0
    """Time for a sentence to be spoken."""
    navigation_retries: int = 2
    """Other paths when blocked, those that navigation tried itself included [count]."""
    people_patience: float = 300.0
    """How long it tries again where people are all that blocks the way: people at home walk on within minutes."""
    view_patience: float = 30.0
    """How long a search is held up on the way to a view before it looks elsewhere first: several times what it takes
    to pass somebody."""
    drive_by: Literal["words", "poses"] = "words"
    """`words`: places and home as words on `brain/navigation_goal`; `poses`: these, too, on `nav_goal`, for a navigator
    that takes nothing else."""
    grab_retries: int = 2
    """Further tries of a grasp, each after driving up again [count]."""
    release_retries: int = 2
    """Further tries of a release [count]."""
    journal: str = "missions.db"
    """File of the missions, relative to the process's state directory; "" keeps them in memory only."""
    resume_within: float = 600.0
    """How long after a crash a mission is resumed, in wall time."""
    run: str = ""
    """Run of the whole robot that this brain belongs to: within one, a mission outlives also an orderly restart."""
    check_timeout: float = 8.0
    """Time for perception to tell where a released object is: four times what it needs on a slow machine."""
    put_right_attempts: int = 2
    """How often what is not where it belongs is picked up and put down again [count]."""
