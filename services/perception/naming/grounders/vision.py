"""A model that sees as a grounder: any OpenAI-compatible chat endpoint that takes pictures.

Objects get numbered marks in the picture (set-of-mark prompting, Yang et al., 2023), the model names a number, and what
is no number of a mark is not believed.
"""

import asyncio
import base64
import importlib.util
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from common.chat import ChatError, Endpoint, complete
from common.rendering.encode import jpeg
from services.perception.naming.grounders.grounder import Candidate, Choice, GrounderError, Question

TRIES = 2
"""Questions asked before a malformed answer counts as none."""
QUALITY = 85
"""JPEG quality; marks stay sharp."""
COLOURS = ((230, 25, 75), (0, 130, 200), (245, 130, 48), (60, 180, 75), (145, 30, 180), (0, 0, 0))
"""Of marks next to each other; Trubetskoy's list of distinct colours."""
ASKED = """\
The objects in the picture have boxes with numbers. Which of them is "{phrase}"?
Answer with JSON only: {{"number": N, "confidence": C, "reason": "..."}}. N is the number of the one object that is
meant, 0 if none of the numbered objects is; C is how sure you are, from 0 to 1."""


class Answer(msgspec.Struct):
    """What the model says."""

    number: int
    confidence: float = 1.0
    reason: str = ""


class Vision:
    """Asks the endpoint at `url` for `timeout` seconds at most, all tries together."""

    def __init__(self, url: str, model: str, key: str, timeout: float) -> None:
        if not url.startswith(("http://", "https://")):
            raise GrounderError(f"set perception.vision_url to the endpoint's http address, not {url!r}")
        if not model:
            raise GrounderError("set perception.vision_model to a model of the endpoint that takes pictures")
        if importlib.util.find_spec("openai") is None:
            raise GrounderError("the package openai is missing: pip install 'tidybot-zenoh[llm]'")
        self._where = Endpoint(url, model, key, timeout)

    def choose(self, question: Question) -> Choice:
        """The candidate whose number the model names."""
        if not question.candidates:
            return Choice(detail="nothing is in view")
        picture = marked(question.picture, question.candidates)
        try:
            return asyncio.run(asyncio.wait_for(self._choose(question, picture), self._where.timeout))
        except TimeoutError:
            raise GrounderError(f"{self._where.url} did not answer within {self._where.timeout:.0f} s") from None
        except ChatError as error:
            raise GrounderError(f"nothing from {self._where.url}: {error}") from None

    async def _choose(self, question: Question, picture: bytes) -> Choice:
        talk: list[dict[str, Any]] = [{"role": "user", "content": _content(question.phrase, picture)}]
        wrong = ""
        for _ in range(TRIES):
            said = await complete(self._where, talk, {"name": "choice", "schema": msgspec.json.schema(Answer)})
            try:
                return checked(said, question.candidates)
            except ValueError as error:
                wrong = str(error)
            talk += [{"role": "assistant", "content": said}, {"role": "user", "content": f"That is wrong: {wrong}"}]
        raise GrounderError(f"no usable answer: {wrong}")


def checked(said: str, candidates: tuple[Candidate, ...]) -> Choice:
    """The choice that an answer makes.

    Raises:
        ValueError: it is no JSON of the right form, or names no mark.
    """
    try:
        answer = msgspec.json.decode(said, type=Answer)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"malformed answer: {error}") from None
    if not 0 <= answer.number <= len(candidates):
        raise ValueError(f"there is no number {answer.number}, only 1 to {len(candidates)}, or 0 for none")
    if not 0.0 <= answer.confidence <= 1.0:
        raise ValueError(f"the confidence {answer.confidence} is not between 0 and 1")
    reason = " ".join(answer.reason.split())[:200]
    if not answer.number:
        return Choice(confidence=answer.confidence, detail=f"none of them: {reason}")
    found = candidates[answer.number - 1]
    return Choice(found.key, answer.confidence, f"{found.label}: {reason}")


def marked(picture: NDArray[np.uint8], candidates: tuple[Candidate, ...]) -> bytes:
    """The picture as a JPEG, with a box and a number from 1 around each candidate."""
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    font = ImageFont.load_default(max(14, image.height // 36))
    for n, one in enumerate(candidates):
        colour = COLOURS[n % len(COLOURS)]
        left, top, right, bottom = one.box
        draw.rectangle((left - 2, top - 2, right + 2, bottom + 2), outline=colour, width=2)
        text = str(n + 1)
        _, _, width, height = draw.textbbox((0, 0), text, font=font)
        # Above the box, so that the number hides nothing of the object; inside the picture in any case.
        x, y = max(0, left - 2), max(0, top - height - 6)
        draw.rectangle((x, y, x + width + 6, y + height + 4), fill=colour)
        draw.text((x + 3, y + 1), text, font=font, fill=(255, 255, 255))
    return jpeg(image, QUALITY)


def _content(phrase: str, picture: bytes) -> list[dict[str, Any]]:
    url = f"data:image/jpeg;base64,{base64.b64encode(picture).decode()}"
    return [
        {"type": "text", "text": ASKED.format(phrase=phrase)},
        {"type": "image_url", "image_url": {"url": url}},
    ]
