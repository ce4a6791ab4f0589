"""Keeps the result of each mutant as it comes, so that a run goes on where it was stopped."""

import hashlib
import json

from .source_text import without_comments_and_texts


def code_fingerprint(path):
    """Returns a fingerprint of a source file's code: comments, texts and the breaks between lines do not change it."""
    code = " ".join(without_comments_and_texts(path.read_text(encoding="utf-8")).split())
    return hashlib.sha256(code.encode()).hexdigest()[:12]


def folder_fingerprint(folder):
    """Returns a fingerprint of the contents of all files below a folder."""
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            digest.update(path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:12]


class Results:
    """Keeps the last outcome of each mutant: killed, survived, or broken (it could not be compiled)."""

    def __init__(self, path):
        self._path = path
        self._by_name = {}
        if path.is_file():
            for line in path.read_text(encoding="utf-8").splitlines():
                result = json.loads(line)
                self._by_name[result["name"]] = result

    def add(self, mutant, outcome, by, seconds, source, tests):
        """Adds a result. by: the test that killed the mutant. source, tests: fingerprints of the code and of the tests then."""
        result = {**mutant._asdict(), "outcome": outcome, "by": by, "seconds": round(seconds, 1), "source": source, "tests": tests}
        self._by_name[mutant.name] = result
        self._path.parent.mkdir(parents=True, exist_ok=True)
        with self._path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(result) + "\n")
        return result

    def of(self, mutant, source, tests):
        """Returns the result that still holds, with the mutant's line of today.

        A mutant that survived has to face new tests, unless `tests` is None. One that was killed stays so while the code of
        its file is the same.
        """
        result = self._by_name.get(mutant.name)
        if not result or result["source"] != source:
            return None
        if result["outcome"] == "survived" and tests not in (None, result["tests"]):
            return None
        return {**result, **mutant._asdict()}
