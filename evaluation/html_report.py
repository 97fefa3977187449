"""The report of an evaluation as one self-contained HTML file: `tidybot eval --html FILE`."""

from collections.abc import Sequence
from html import escape
from typing import Any

from evaluation.case import Result
from evaluation.html_stages import bars, by_stage, strip
from evaluation.report import rates
from evaluation.statistics import share
from services.dashboard.timeline import document

STYLE = """
.gallery { display: grid; grid-template-columns: repeat(auto-fill, minmax(320px, 1fr)); gap: 16px; }
figure { margin: 0; border: 1px solid #dee2e6; border-radius: 6px; padding: 10px; }
figcaption { margin-top: 6px; } details pre { white-space: pre-wrap; font-size: 12px; }
dl { display: grid; grid-template-columns: max-content auto; gap: 2px 16px; } dt { color: #868e96; } dd { margin: 0; }
"""


def render(report: dict[str, Any], results: Sequence[Result]) -> str:
    """The whole page. Nothing in it comes from anywhere else."""
    rows = sorted(results, key=lambda r: r.seed)
    failed = [r for r in rows if not r.met]
    parts = [
        f"<h1>tidybot eval, suite {escape(report['suite'])}</h1>",
        _summary(report),
        "<h2>Success by stage</h2><p class='faint'>Whiskers: 95 % Wilson intervals of the true share.</p>",
        bars([*by_stage(rows), ("as expected", sum(r.met for r in rows), len(rows))]),
        "<h2>Robot time of a case</h2>",
        strip(
            [(r.sim_seconds, r.met, _title(r)) for r in rows],
            "s",
            _round(max((r.sim_seconds for r in rows), default=1.0)),
        ),
        "<h2>Path efficiency (SPL)</h2>",
        strip([(r.spl, r.met, _title(r)) for r in rows if r.evidence.get("expected") == "delivered"], "", 1.0),
    ]
    if report["by_cause"]:
        causes = "".join(
            f"<tr><td>{escape(cause)}</td><td>{share(number, len(rows))}</td><td>"
            f"{' '.join(str(r.seed) for r in rows if r.cause == cause)}</td></tr>"
            for cause, number in report["by_cause"].items()
        )
        parts.append(f"<h2>Causes</h2><table><tr><th>stage</th><th>cases</th><th>seeds</th></tr>{causes}</table>")
    if failed:
        parts.append(f"<h2>Failures</h2><div class='gallery'>{''.join(_figure(r) for r in failed)}</div>")
    parts.append(f"<h2>All cases</h2><table>{_HEAD}{''.join(_row(r) for r in rows)}</table>")
    return document(f"tidybot eval {report['suite']}", "\n".join(parts), STYLE)


def _summary(report: dict[str, Any]) -> str:
    wall = max(report["wall_seconds"], 0.1)
    facts = {
        **rates(report),
        "bar": f"{100 * report['bar']:.0f} % as expected: {'met' if report['passed'] else 'not met'}",
        "path efficiency (SPL)": f"{report['spl']:.2f}",
        "robot time": f"{report['sim_seconds']:.0f} s, {report['sim_seconds'] / wall:.1f} x real time",
        "wall time": f"{report['wall_seconds']:.0f} s",
    }
    return "<dl>" + "".join(f"<dt>{k}</dt><dd>{v}</dd>" for k, v in facts.items()) + "</dl>"


def _figure(result: Result) -> str:
    """What a case that went wrong looked like in the end, what was said, and its log."""
    evidence = result.evidence
    picture = evidence.get("picture")
    image = f'<img alt="the end of seed {result.seed}" src="data:image/jpeg;base64,{picture}">' if picture else ""
    log = evidence.get("timeline")
    lines = "\n".join(map(str, log)) if isinstance(log, list) else ""
    log_html = f"<details><summary>mission log</summary><pre>{escape(lines)}</pre></details>" if lines else ""
    said = evidence.get("said")
    last = f"<br>it said “{escape(str(said[-1]))}”" if isinstance(said, list) and said else ""
    return (
        f"<figure>{image}<figcaption><b>seed {result.seed}</b> {escape(result.name)} “{escape(result.command)}”<br>"
        f'<span class="bad">{escape(result.outcome)}: {escape(result.cause)}</span><br>'
        f"{escape(str(evidence.get('reason', '')))}{last}</figcaption>{log_html}</figure>"
    )


COLUMNS = ("seed", "case", "command", "outcome", "false claims", "robot s", "SPL", "cause")
_HEAD = f"<tr>{''.join(f'<th>{c}</th>' for c in COLUMNS)}</tr>"


def _row(result: Result) -> str:
    colour = "good" if result.met else "bad"
    return (
        f"<tr><td>{result.seed}</td><td>{escape(result.name)}</td><td>{escape(result.command)}</td>"
        f'<td class="{colour}">{escape(result.outcome)}</td><td>{result.false_claims}</td>'
        f"<td>{result.sim_seconds:.1f}</td><td>{result.spl:.2f}</td><td>{escape(result.cause)}</td></tr>"
    )


def _title(result: Result) -> str:
    return f"seed {result.seed} {result.command}: {result.outcome}, {result.sim_seconds:.0f} s, SPL {result.spl:.2f}"


def _round(top: float) -> float:
    """The next number that an axis may end at."""
    return next((s for s in (10, 20, 50, 100, 150, 200, 300, 400, 600, 1000, 2000) if s >= top), top)
