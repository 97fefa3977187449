"""`python -m services.planner.language_model.diagnosis`: who plans on this machine, as JSON for `tidybot doctor`."""

import os
import sys

import msgspec

from common import config
from services.planner.config import PlannerConfig
from services.planner.language_model import endpoint

OLLAMA = "http://127.0.0.1:11434/v1"
"""Where Ollama listens if it is not told otherwise."""
SHOWN = 5
"""Names of models in one line; chosen: they fit a terminal."""


class Diagnosis(msgspec.Struct):
    """What was found, in the fields of the doctor's findings. `level`: ok, note or error; `fix`: a command."""

    level: str
    state: str
    fix: str = ""
    what: str = "language model"


def diagnose() -> Diagnosis:
    """Look at the planner's parameters and, unless they want the grammar, at the endpoint that they name."""
    try:
        planner = config.load("planner", PlannerConfig, config.config_dir(), config.overrides(os.environ, ()))
    except config.ConfigError as error:
        return Diagnosis("error", str(error), "correct planner.toml or the TIDYBOT__PLANNER__ variables")
    if planner.backend == "grammar":
        return Diagnosis("ok", "none wanted: planner.backend = grammar")
    if not endpoint.installed():
        level = "error" if planner.backend == "llm" else "note"
        fix = ".venv/bin/pip install 'tidybot-zenoh[llm]'"
        return Diagnosis(level, "the openai package is missing: the grammar plans", fix)
    found = endpoint.look(planner.llm_url, planner.llm_key)
    if not found.good:
        other = endpoint.look(OLLAMA) if planner.llm_url != OLLAMA else found
        fix = "start one there (docs/COMMANDS.md), or go on without"
        if other.good:
            fix = f"export TIDYBOT__PLANNER__LLM_URL={OLLAMA}   (Ollama answers there)"
        return Diagnosis("note", f"{planner.llm_url}: {found.why}; the grammar plans", fix)
    model = endpoint.model_of(planner.llm_model, found)
    listed = ", ".join(found.models[:SHOWN]) + (", ..." if len(found.models) > SHOWN else "")
    known = model in found.models or not found.models
    fix = "" if known else f"export TIDYBOT__PLANNER__LLM_MODEL={found.models[0]}"
    state = f"{planner.llm_url} answers; {model} plans" + (f" (of {listed})" if listed else "")
    return Diagnosis("ok" if known else "note", state, fix)


if __name__ == "__main__":
    sys.stdout.write(msgspec.json.encode(diagnose()).decode() + "\n")
