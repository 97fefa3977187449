"""Textures of objects: a ground colour, a pattern, and print. Pure."""

from functools import cache

from PIL import Image, ImageDraw, ImageFont

from common.rendering.encode import png
from common.scene import Pattern

Rgb = tuple[int, int, int]
WIDTH = 768
"""Pixels around a thing: 3 a millimetre on a can of 75 mm, more than a camera sees from 0.25 m."""
TRIM = 0.06
"""Share of a picture's height, at its top, in the second colour: for rims, lids and insides."""
SHARE = 0.62
"""Of the width of a side (half of what goes around) that print takes at most."""
FONTS = ("LiberationSans-Bold.ttf", "DejaVuSans-Bold.ttf")
"""Tried in turn; Pillow has a face of its own where none is installed."""


@cache
def _font(size: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    for name in FONTS:
        try:
            return ImageFont.truetype(name, size)
        except OSError:
            continue
    return ImageFont.load_default(size)


def rgb(colour: tuple[float, ...]) -> Rgb:
    """A colour of shares (0 to 1) as levels (0 to 255)."""
    r, g, b = (round(255 * v) for v in colour[:3])
    return r, g, b


def ink(ground: Rgb) -> Rgb:
    """Black or white, whichever stands out more: by luma, ITU-R BT.601."""
    return (20, 20, 20) if 0.299 * ground[0] + 0.587 * ground[1] + 0.114 * ground[2] > 128 else (245, 245, 245)


def around(label: str, ground: Rgb, second: Rgb, pattern: Pattern, round_by: float, height: float) -> bytes:
    """What goes once around a thing of circumference `round_by` and `height` [m], with the print on two sides: PNG."""
    size = WIDTH, max(64, round(WIDTH * height / round_by))
    image = _ground(size, ground, second, pattern)
    middle = SHARE * size[0] / 2
    for side in (0.25, 0.75):
        _print(image, label, (side * size[0], size[1] / 2), (middle, 0.55 * size[1]), ground, second, pattern)
    trim = round(size[1] * TRIM / (1 - TRIM))
    whole = Image.new("RGB", (size[0], size[1] + trim), second)
    whole.paste(image, (0, trim))
    return png(whole)


def sides(
    label: str, ground: Rgb, second: Rgb, pattern: Pattern, size: tuple[float, float, float], spine: bool = False
) -> bytes:
    """The six sides of a box of `size` (x, y, z) [m] as `mesh.box` wants them: PNG.

    The print is on front and back and, small, on top; with `spine` (a book) also along the sides.
    """
    cell = WIDTH // 3
    x, y, z = size
    wide = {"front": (y, z), "right": (x, z), "back": (y, z), "left": (x, z), "top": (y, x), "bottom": (y, x)}
    atlas = Image.new("RGB", (3 * cell, 2 * cell))
    for n, (name, (width, height)) in enumerate(wide.items()):
        # Drawn in its own proportions and then squeezed into its sixth.
        scale = 2 * cell / max(width, height)
        true = max(16, round(width * scale)), max(16, round(height * scale))
        image = _ground(true, ground, second, pattern)
        if name in ("front", "back", "top") or (spine and name in ("left", "right")):
            centre, room = (true[0] / 2, true[1] / 2), (0.8 * true[0], 0.5 * true[1])
            _print(image, label, centre, room, ground, second, pattern)
        atlas.paste(image.resize((cell, cell), Image.Resampling.LANCZOS), ((n % 3) * cell, (n // 3) * cell))
    return png(atlas)


def _ground(size: tuple[int, int], ground: Rgb, second: Rgb, pattern: Pattern) -> Image.Image:
    image = Image.new("RGB", size, ground)
    draw, (width, height) = ImageDraw.Draw(image), size
    step = max(12, width // 16)
    match pattern:
        case "band":
            draw.rectangle((0, 0.26 * height, width, 0.74 * height), fill=second)
        case "stripes":
            for left in range(0, width, 2 * step):
                draw.rectangle((left, 0, left + step - 1, height), fill=second)
        case "dots":
            for row, top in enumerate(range(0, height, step)):
                for left in range(step * (row % 2), width, 2 * step):
                    near, far = 0.2 * step, 0.8 * step
                    draw.ellipse((left + near, top + near, left + far, top + far), fill=second)
        case "check":
            for row, top in enumerate(range(0, height, step)):
                for left in range(step * (row % 2), width, 2 * step):
                    draw.rectangle((left, top, left + step - 1, top + step - 1), fill=second)
    return image


def _print(
    image: Image.Image,
    label: str,
    centre: tuple[float, float],
    room: tuple[float, float],
    ground: Rgb,
    second: Rgb,
    pattern: Pattern,
) -> None:
    """The label in lines that fit the room (width, height) [px] around a point, over patterns on a field."""
    if not label:
        return
    draw, words = ImageDraw.Draw(image), label.split()
    best = max(_layouts(words), key=lambda lines: _size(lines, room))
    size = _size(best, room)
    if size < 8:
        return
    font = _font(size)
    boxes = [draw.textbbox((0, 0), line, font=font) for line in best]
    wide, high = max(b[2] - b[0] for b in boxes), size * 1.15 * len(best)
    field = ground
    if pattern == "band":
        field = second
    elif pattern != "plain":
        edge = size * 0.3
        corners = (centre[0] - wide / 2 - edge, centre[1] - high / 2 - edge / 2)
        ends = (centre[0] + wide / 2 + edge, centre[1] + high / 2 + edge / 2)
        draw.rounded_rectangle((*corners, *ends), radius=edge, fill=ground)
    for n, line in enumerate(best):
        at = centre[0], centre[1] + (n - (len(best) - 1) / 2) * size * 1.15
        draw.text(at, line, font=font, fill=ink(field), anchor="mm")


def _layouts(words: list[str]) -> list[list[str]]:
    """The words in one line, two, or one each."""
    found = [[" ".join(words)], words]
    found += [[" ".join(words[:n]), " ".join(words[n:])] for n in range(1, len(words))]
    return found


def _size(lines: list[str], room: tuple[float, float]) -> int:
    """Height of the letters [px] with which the lines fill the room."""
    probe = _font(100)
    wide = max(probe.getlength(line) for line in lines)
    return int(min(100 * room[0] / max(wide, 1.0), room[1] / (1.15 * len(lines))))
