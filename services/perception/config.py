"""Parameters of perception."""

from common.config import Config


class PerceptionConfig(Config, frozen=True):
    """`detector` is `classical` or `package.module:Class` of a detector of one's own (see detect.Detector).

    A picture is taken every `period` seconds while the robot moves or works, every `idle_period` while it rests,
    and at once for a query; one of `fine_width` x `fine_height` to `read` what is printed on objects, when words are
    asked for that name none, and to see what a name is taught for. While the base turns faster than `max_turn` [rad/s]
    pictures are not worth having."""

    detector: str = "classical"
    width: int = 640
    height: int = 480
    period: float = 1.0
    idle_period: float = 5.0
    max_turn: float = 0.35
    max_range: float = 3.5
    detection_seconds: float = 0.15
    picture_timeout: float = 1.5
    query_pictures: int = 2
    min_confidence: float = 0.6
    gone_after: int = 3
    read: bool = True
    fine_width: int = 1280
    fine_height: int = 960
    synonyms: dict[str, str] = {}
