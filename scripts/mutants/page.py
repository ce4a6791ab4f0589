"""Writes the page about the mutation test: the score by folder, and the mutants that survive."""

from collections import Counter

import yaml

TEXT = """# Mutation test
A test that cannot fail proves nothing. `scripts/mutation` puts plausible slips into the code, one at a time, and looks whether a test
fails. Such slips are a dropped term of a variance, a wrong sign, a forgotten reset, a swallowed error, or a field that is mixed up with
its neighbour.

```
scripts/mutation --seed 1 --number 30                      # thirty mutants of the whole tree, some minutes
scripts/mutation --seed 2 --number 30 src/core/integrity   # of one folder, or of one file
scripts/mutation --seed 1 --number 300 --page              # writes this page
```
- It works on a copy of the tree in `build/mutation/`. There it builds each mutant and runs the tests that reach the changed file by
  includes. The nearest come first, and of these the quickest. A test that fails has to pass without the mutant.
  Remove `build/mutation/tree` before you run the tests of the tree itself: `roslaunch` would find each launch file twice.
- A header that many sources see is compiled into the nearest ones first, and into all of them when that kills nothing.
- It keeps every result and goes on where it was stopped. A killed mutant counts as long as the code of its file is the same,
  whatever happens to comments and texts. A survivor has to face new tests again. A mutant that cannot be compiled does not count.

A mutant that survives shows a missing test, or code that does nothing. `test/mutation/judged.yaml` names those that somebody has
looked at. *Equivalent* ones, which no input can tell from the original, have the reason there, and others what is missing.
"""


def read_judged(path):
    """Reads verdicts by the mutants' names: {name: {verdict: equivalent or survives, why: text}}."""
    judged = yaml.safe_load(path.read_text(encoding="utf-8")) if path.is_file() else {}
    for name, entry in (judged or {}).items():
        if set(entry) - {"where", "verdict", "why"} or entry.get("verdict") not in ("equivalent", "survives") or not entry.get("why"):
            raise ValueError(f"{path}: {name}: expected where, verdict (equivalent or survives) and why")
    return judged or {}


def outcome(result, judged):
    """Returns killed, equivalent or survived."""
    if result["outcome"] == "survived" and judged.get(result["name"], {}).get("verdict") == "equivalent":
        return "equivalent"
    return result["outcome"]


def folder(path):
    """Returns the folder a file counts to, src/core/height for src/core/height/height_filter.cpp. Public headers count alike."""
    parts = path.split("/")[:-1]
    return "/".join((["src", "core"] + parts[2:] if parts[0] == "include" else parts)[:3])


def score(results, judged):
    """Returns counters by folder, and that of all folders as 'all'."""
    counts = {}
    for result in results:
        for where in (folder(result["path"]), "all"):
            counts.setdefault(where, Counter())[outcome(result, judged)] += 1
    return counts


def share(count):
    return (count["killed"] + count["equivalent"]) / sum(count.values())


def _cell(code):
    return "`" + code.strip().replace("|", "\\|") + "`"


def render(results, judged, seed, drawn):
    """Writes the page. drawn: mutants of the sample, judged or not."""
    counts = score(results, judged)
    lines = [TEXT, f"## Score\nSeed {seed}: {len(results)} of {drawn} mutants have been judged.\n", "| folder | mutants | killed | equivalent | survive | score |",
             "|---|---|---|---|---|---|"]
    for where in sorted(counts, key=lambda name: (name == "all", name)):
        count = counts[where]
        lines.append(f"| {where} | {sum(count.values())} | {count['killed']} | {count['equivalent']} | {count['survived']} | "
                     f"{share(count):.0%} |")
    left = [result for result in results if outcome(result, judged) == "survived"]
    lines += ["", "## What survives", "| where | instead of | this is taken | why |", "|---|---|---|---|"] if left else []
    lines += [f"| {r['path']}:{r['line']} | {_cell(r['before'])} | {_cell(r['after'])} | {judged.get(r['name'], {}).get('why', '')} |"
              for r in sorted(left, key=lambda r: (r["path"], r["line"]))]
    same = [result for result in results if outcome(result, judged) == "equivalent"]
    lines += ["", "## Equivalent", "| where | instead of | this does the same | why |", "|---|---|---|---|"] if same else []
    lines += [f"| {r['path']}:{r['line']} | {_cell(r['before'])} | {_cell(r['after'])} | {judged[r['name']]['why']} |"
              for r in sorted(same, key=lambda r: (r["path"], r["line"]))]
    return "\n".join(lines) + "\n"
