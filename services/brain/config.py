"""Parameters of the brain (`config/brain.toml`). All durations in seconds of robot time."""

from typing import Literal

from common.config import Config


class BrainConfig(Config, frozen=True):
    """`settle` follows every arrival and every finished manipulation; a limit of n retries means n + 1 tries."""

    pipeline: Literal["fetch", "vla"] = "fetch"
    enable_confirmation: bool = True
    max_retry_attempts: int = 3
    confirm_below: float = 0.8
    settle: float = 1.0
    speech_retry_delay: float = 5.0
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
    grab_retries: int = 2
    release_retries: int = 2
