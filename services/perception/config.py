"""Parameters of perception."""

from common.config import Config


class PerceptionConfig(Config, frozen=True):
    """Which detector and which grounder, and when a picture is taken."""

    detector: str = "classical"
    """`classical`, or `package.module:Class` of a detector of one's own (see detect.Detector)."""
    width: int = 640
    """Columns of the pictures [pixels]."""
    height: int = 480
    """Rows of the pictures [pixels]."""
    period: float = 1.0
    """Time between pictures while the robot works or stands elsewhere than for the last one, at least [s]."""
    idle_period: float = 5.0
    """Time between pictures at the most [s]."""
    stride: float = 0.5
    """Way between pictures while it drives [m]."""
    laden_stride: float = 1.5
    """The same with something in its hand [m]."""
    sweep: float = 0.5
    """Turn between pictures while it drives [rad]."""
    max_turn: float = 0.35
    """Turn of the base from which on pictures are not worth having [rad/s]."""
    max_range: float = 3.5
    """Distance from which on things are left alone [m]."""
    detection_seconds: float = 0.15
    """What a detection takes in lockstep [s]."""
    picture_timeout: float = 1.5
    """Age at which a picture that was asked for is given up [s]."""
    query_pictures: int = 2
    """Pictures taken for a query before its answer is that nothing is there [count]."""
    min_confidence: float = 0.6
    """Confidence below which a thing is not reported, 0 to 1."""
    gone_after: int = 3
    """Views in which a thing should have been seen and was not, before it is gone [count]."""
    read: bool = True
    """Read what is printed on objects when words are asked for that name none (needs the extra `ocr`)."""
    grounder: str = "words"
    """Who is asked which object is meant where words, names and print do not tell: `words` nobody, `clip` the ONNX
    export `clip_model`, `vision` the model at `vision_url` (docs/EXTENDING.md)."""
    clip_model: str = ""
    """Folder of an ONNX export of CLIP, or its name on the hub."""
    clip_least: float = 0.5
    """Confidence from which on `clip` is believed, 0 to 1."""
    vision_url: str = ""
    """OpenAI-compatible endpoint that takes pictures, such as http://127.0.0.1:11434/v1."""
    vision_model: str = ""
    """Name of its model."""
    vision_key: str = ""
    """Its key; belongs into the environment."""
    vision_timeout: float = 6.0
    """Time for its answer [s]."""
    grounder_seconds: float = 1.0
    """What an answer of `grounder` takes in lockstep [s]."""
    fine_width: int = 1920
    """Columns of the pictures in which it reads, or sees what a name is taught for [pixels]."""
    fine_height: int = 1440
    """Rows of such a picture [pixels]."""
    synonyms: dict[str, str] = {}
    """What people say -> the household's word."""
