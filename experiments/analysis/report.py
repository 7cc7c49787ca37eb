"""Writes what rows come to: plots, tables as CSV, a page, and short tables for documents."""

import base64
import re
from pathlib import Path

from jinja2 import Environment, FileSystemLoader
from markupsafe import Markup

from . import accuracy, bends, breaking, cases, costs, heights, success, trust
from .methods import with_held_answers
from .plots import to_svg
from .section import TEXTS

_MAKERS = (success.section, accuracy.section, accuracy.inlier_section, cases.section,
           breaking.section, bends.section, heights.section, trust.section, costs.section)
_LONG_CELL = 40
_BLOCK = re.compile(r"<!-- analyse: ([\w-]+)/([\w-]+) -->\n.*?<!-- end -->", re.DOTALL)


class DocumentError(Exception):
    """A document that asks for a table that the rows do not have, or for none."""


def sections(rows):
    rows = with_held_answers(rows)
    return [made for made in (make(rows) for make in _MAKERS) if made]


def origin(rows):
    """How many rows, of which sources."""
    parts = [f"{len(of)} of source {source} ({', '.join(dict.fromkeys(of.suite))}; seeds "
             f"{of.seed.min()} to {of.seed.max()})"
             for source, of in rows.groupby("source", sort=False)]
    kinds = ", ".join(dict.fromkeys(rows.kind))
    return f"{len(rows)} runs on {kinds} pairs: {'; '.join(parts)}."


def markdown(frame):
    """A table in GitHub's Markdown; numbers to the right."""
    right = {name: frame[name].map(lambda v: not isinstance(v, str)).all() for name in frame}
    lines = ["| " + " | ".join(map(str, frame.columns)) + " |",
             "|" + "|".join("--:" if right[name] else "---" for name in frame) + "|"]
    lines += ["| " + " | ".join(map(str, line)) + " |" for line in frame.itertuples(index=False)]
    return "\n".join(lines) + "\n"


def tables_of(made):
    """By name, those that documents may have."""
    return {table.name: markdown(table.shown) for section in made for table in section.tables
            if table.shown is not None}


def _block(folder, name, table):
    return f"<!-- analyse: {folder}/{name} -->\n{table}<!-- end -->"


def update_document(text, folder, tables):
    """The document with its tables of one folder written anew; raises DocumentError."""
    found = [match[2] for match in _BLOCK.finditer(text) if match[1] == folder]
    missing = [name for name in found if name not in tables]
    if missing or not found:
        asked = f"tables that are not there: {', '.join(missing)}" if missing else "no table"
        raise DocumentError(f"the document asks for {asked} of '{folder}'; there are: "
                            + ", ".join(tables))
    return _BLOCK.sub(lambda match: match[0] if match[1] != folder else _block(
        folder, match[2], tables[match[2]]), text)


def _page(made, svgs, title, text):
    views = []
    for section in made:
        words = TEXTS["sections"][section.name]
        views.append({
            "title": words["title"], "text": f"{section.facts} {words['text']}",
            "plots": [{"caption": TEXTS["plots"][name], "data": "data:image/svg+xml;base64,"
                       + base64.b64encode(svgs[name].encode()).decode()} for name in section.plots],
            "tables": [{"caption": TEXTS["tables"][table.name], "csv": table.name,
                        "long": _is_long(table.shown),
                        "html": Markup(table.shown.rename_axis(columns=None).to_html(
                            index=False, border=0))}
                       for table in section.tables if table.shown is not None]})
    environment = Environment(loader=FileSystemLoader(Path(__file__).parent), autoescape=True)
    return environment.get_template("page.html").render(title=title, origin=text, sections=views)


def _is_long(frame):
    return bool((frame.astype(str).applymap(len) > _LONG_CELL).any(axis=None))


def write(rows, folder, title):
    """Returns the tables for documents by name."""
    folder.mkdir(parents=True, exist_ok=True)
    made = sections(rows)
    svgs = {name: to_svg(figure) for section in made for name, figure in section.plots.items()}
    for name, svg in svgs.items():
        (folder / f"{name}.svg").write_text(svg, encoding="utf-8")
    for section in made:
        for table in section.tables:
            table.full.to_csv(folder / f"{table.name}.csv", index=False, float_format="%.5g")
    shown = tables_of(made)
    (folder / "tables.md").write_text("\n\n".join(
        _block(folder.name, name, text) for name, text in shown.items()) + "\n", encoding="utf-8")
    (folder / "index.html").write_text(_page(made, svgs, title, origin(rows)), encoding="utf-8")
    return shown
