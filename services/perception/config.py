"""Parameters of perception."""

from common.config import Config


class PerceptionConfig(Config, frozen=True):
    """`grounder` is asked which object is meant where words, names and print do not tell: `words` nobody, `clip` the
    ONNX export in the folder or of the hub's name `clip_model`, believed from the confidence `clip_least` on, `vision`
    the model `vision_model` at the OpenAI-compatible endpoint `vision_url`, with `vision_key`, for `vision_timeout`
    seconds. In lockstep an answer takes `grounder_seconds`.

    `detector` is `classical` or `package.module:Class` of a detector of one's own (see detect.Detector).

    A picture is taken every `period` seconds while the robot works or stands elsewhere than for the last one, while it
    drives after each `stride` [m], or `laden_stride` with something in its hand, or `sweep` [rad], every `idle_period`
    at the latest, and at once for a query; one of `fine_width` x `fine_height` to `read` what is printed on objects,
    when words are asked for that name none, and to see what a name is taught for. While the base turns faster than
    `max_turn` [rad/s] pictures are not worth having."""

    detector: str = "classical"
    width: int = 640
    height: int = 480
    period: float = 1.0
    idle_period: float = 5.0
    stride: float = 0.5
    laden_stride: float = 1.5
    sweep: float = 0.5
    max_turn: float = 0.35
    max_range: float = 3.5
    detection_seconds: float = 0.15
    picture_timeout: float = 1.5
    query_pictures: int = 2
    min_confidence: float = 0.6
    gone_after: int = 3
    read: bool = True
    grounder: str = "words"
    clip_model: str = ""
    clip_least: float = 0.5
    vision_url: str = ""
    vision_model: str = ""
    vision_key: str = ""
    vision_timeout: float = 6.0
    grounder_seconds: float = 1.0
    fine_width: int = 1920
    fine_height: int = 1440
    synonyms: dict[str, str] = {}
