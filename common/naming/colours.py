"""The words for colours as red, green and blue (0 to 1), for those who draw what has no other look."""

COLOURS = {
    "red": (0.80, 0.12, 0.12),
    "green": (0.12, 0.55, 0.20),
    "blue": (0.15, 0.30, 0.80),
    "yellow": (0.92, 0.78, 0.12),
    "orange": (0.95, 0.50, 0.10),
    "white": (0.92, 0.92, 0.90),
    "black": (0.10, 0.10, 0.11),
    "brown": (0.45, 0.30, 0.18),
    "grey": (0.55, 0.55, 0.57),
    "purple": (0.50, 0.25, 0.60),
    "pink": (0.92, 0.55, 0.66),
}
UNKNOWN_COLOUR = (0.6, 0.6, 0.62)
"""Of what has a colour that no word says."""
