"""Keeps the results of the sections as JSON, so that the page can be made anew without measuring anew."""

import datetime
import json
from pathlib import Path

from .programs import WORK, pending


def path(section):
    return WORK / "results" / f"{section}.json"


def keep(section, results):
    """Keeps the results of a section, with today's date."""
    path(section).parent.mkdir(parents=True, exist_ok=True)
    content = {"measured": datetime.datetime.now().strftime("%Y-%m-%d %H:%M"), "results": results}
    with pending(path(section)) as temporary:
        Path(temporary).write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def recall(section):
    """Returns date and results of a section, or None when it has never been measured."""
    if not path(section).exists():
        return None
    content = json.loads(path(section).read_text(encoding="utf-8"))
    return content["measured"], content["results"]
