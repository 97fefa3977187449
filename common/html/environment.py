"""HTML from Jinja2 templates; whatever is put into one is escaped."""

from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

HERE = Path(__file__).parent


def environment(*folders: Path) -> Environment:
    """Templates (`*.html`) of these folders and `document.html`; a variable that was not given is an error."""
    return Environment(
        loader=FileSystemLoader((*folders, HERE)), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True,
    )  # fmt: skip
