"""Parameters of the brain (`config/brain.toml`). All durations in seconds of robot time."""

from typing import Literal

from common.config import Config


class BrainConfig(Config, frozen=True):
    """`settle` follows every arrival and every finished manipulation; a limit of n retries means n + 1 tries.
    `navigation_retries` counts what navigation has tried itself on a blocked way; where people are all that blocks it
    (`PERSON_IN_WAY`), it is tried again for `people_patience`: people at home walk on within minutes. A search that is
    held up on the way to a view for `view_patience`, several times what it takes to pass by, looks elsewhere first.
    `drive_by`: places and the way home as words on `brain/navigation_goal`, or as poses on `nav_goal` for a navigator
    that takes nothing else.

    A mission is suspended while `joint_states` stay away; after `heartbeat_patience` seconds (ten times what a killed
    simulation needs to come back on a busy machine) it ends in ERROR.
    `journal` is relative to the process's state directory; "" keeps missions in memory only. A mission whose brain
    was killed is resumed within `resume_within` seconds of wall time. `run` names the run of the whole robot that
    this brain belongs to: within one, a mission outlives also an orderly restart. After every release perception is
    asked where the object is; it has `check_timeout` for the answer, four times what it needs on a slow machine. What
    is not where it belongs is picked up and put down again at most `put_right_attempts` times.
    """

    pipeline: Literal["fetch", "vla"] = "vla"
    enable_confirmation: bool = True
    max_retry_attempts: int = 3
    confirm_below: float = 0.8
    settle: float = 1.0
    speech_retry_delay: float = 5.0
    heartbeat_patience: float = 60.0
    listen_timeout: float = 60.0
    listen_grace: float = 1.0
    answer_timeout: float = 15.0
    navigation_timeout: float = 180.0
    manipulation_timeout: float = 120.0
    planning_timeout: float = 30.0
    perception_timeout: float = 10.0
    peer_timeout: float = 30.0
    say_timeout: float = 15.0
    navigation_retries: int = 2
    people_patience: float = 300.0
    view_patience: float = 30.0
    drive_by: Literal["words", "poses"] = "words"
    grab_retries: int = 2
    release_retries: int = 2
    journal: str = "missions.db"
    resume_within: float = 600.0
    run: str = ""
    check_timeout: float = 8.0
    put_right_attempts: int = 2
