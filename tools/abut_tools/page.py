"""Self-contained pages: Debian's packaged Chart.js, our style and script, figures and tables."""

import argparse
import html
import json
import os
import string
from pathlib import Path
from typing import Callable

from abut_tools.tables import Figure, ToolError

CHART_LIBRARY = Path("/usr/share/javascript/chart.js/chart.min.js")
PAGE_LIMIT = 1_500_000  # bytes: opens at once on a phone
HERE = Path(__file__).resolve().parent


def named(text: str) -> Path:
    """An empty path is most often a variable of a script that was never set."""
    if not text:
        raise argparse.ArgumentTypeError("is empty: name a path, or leave it out")
    return Path(text)


class Html(str):
    """A cell that is HTML already."""


def escaped(cell: str) -> str:
    return cell if isinstance(cell, Html) else html.escape(cell)


def table_of(headings: list[str], rows: list[list[str]], classes: list[str] | None = None) -> str:
    """Cells are text; only the class of a row may change how it looks."""
    head = "".join(f"<th>{escaped(text)}</th>" for text in headings)
    body = ""
    for k, row in enumerate(rows):
        kind = f' class="{classes[k]}"' if classes and classes[k] else ""
        body += f"<tr{kind}>" + "".join(
            f"<td>{escaped(cell)}</td>" for cell in row) + "</tr>\n"
    return (f'<div class="scroll"><table><thead><tr>{head}</tr></thead>'
            f"<tbody>{body}</tbody></table></div>")


def section(title: str, content: str) -> str:
    return f"<section><h2>{html.escape(title)}</h2>{content}</section>" if content else ""


def canvas_of(figure: Figure) -> str:
    title, name = html.escape(figure.title), html.escape(figure.name)
    return (f'<figure><figcaption>{title}</figcaption><div class="plot">'
            f'<canvas id="{name}" role="img" aria-label="{title}"></canvas></div></figure>\n')


def script_json(data: object) -> str:
    """Data inside a script element, which no text may end."""
    text = json.dumps(data, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return text.replace("</", "<\\/")


def filled(template: Path, library: str, scripts: tuple[str, ...], **parts: str) -> str:
    text = string.Template(template.read_text(encoding="utf-8"))
    return text.substitute(
        parts, style=(HERE / "page.css").read_text(encoding="utf-8"),
        script="".join((HERE / name).read_text(encoding="utf-8") for name in scripts),
        library=library.replace("</script", "<\\/script"))


def fitting_page(make: Callable[[str, int], str], library_path: Path, points: int,
                 beside: int = 0) -> str:
    """The page with as many points per curve, at most `points`, as the limit of its size allows;
    `beside` are bytes that count elsewhere."""
    if not library_path.is_file():
        raise ToolError(f"the chart library {library_path} is not there. Install Debian's "
                        "package libjs-chart.js, or name a copy with --chart-library.", 3)
    library = library_path.read_text(encoding="utf-8")
    page = make(library, points)
    while len(page.encode()) - beside > PAGE_LIMIT and points > 50:
        points //= 2
        page = make(library, points)
    return page


def write_whole(path: Path, text: str) -> None:
    """Nobody ever sees half a file."""
    temporary = path.with_name(path.name + ".tmp")
    temporary.unlink(missing_ok=True)
    with temporary.open("x", encoding="utf-8") as file:  # never through a symbolic link
        file.write(text)
    os.replace(temporary, path)
