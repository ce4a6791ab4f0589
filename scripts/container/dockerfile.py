"""The small part of Dockerfiles that ours uses: stages of instructions, with an error for everything else."""

import json
import re
import shlex
from collections import namedtuple

KNOWN = ("FROM", "RUN", "COPY", "ENV", "USER", "WORKDIR", "ENTRYPOINT")
# Base is a name of an image or of an earlier stage, steps are Steps.
Stage = namedtuple("Stage", "name base steps")
# Arguments: RUN the command, COPY (stage or None, sources, destination), ENV a dict, USER a name, WORKDIR a path, ENTRYPOINT
# the list of words.
Step = namedtuple("Step", "line kind arguments")


class NotUnderstood(Exception):
    """The Dockerfile has something that only a container engine knows, or a mistake."""


def instructions(text):
    """(line number, instruction) with continued lines joined; without comments and empty lines."""
    number, parts = 0, []
    for at, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("#") or (not parts and not line.strip()):
            continue
        number = number if parts else at
        continued = line.rstrip().endswith("\\")
        parts.append(line.rstrip().rstrip("\\").strip())
        if not continued:
            yield number, " ".join(parts)
            parts = []
    if parts:
        raise NotUnderstood(f"line {number}: ends in a backslash, and nothing follows")


def arguments_of(line, kind, rest):
    def refuse(what):
        raise NotUnderstood(f"line {line}: {kind} {what}")

    if kind not in KNOWN:
        refuse(f"is not understood, only {', '.join(KNOWN)}")
    if not rest:
        refuse("has no argument")
    if kind == "RUN":
        if rest.startswith(("[", "--")) or "<<" in rest:
            refuse("has to be a plain command of the shell: no list, no options, no text that follows")
        return rest
    if kind == "ENTRYPOINT":
        try:
            words = json.loads(rest)
        except ValueError:
            words = None
        if not isinstance(words, list) or not words or not all(isinstance(word, str) for word in words):
            refuse('has to be a list, for example ["/bin/entry"]')
        return words
    if "$" in rest:
        refuse("has a variable; write out its value")
    words = shlex.split(rest)
    if kind == "ENV":
        if not all(re.match(r"[A-Za-z_]\w*=", word) for word in words):
            refuse("has to be NAME=VALUE ...")
        return dict(word.split("=", 1) for word in words)
    if kind == "COPY":
        source = None
        if words[0].startswith("--from="):
            source = words.pop(0)[len("--from="):]
        if any(word.startswith("--") for word in words):
            refuse("has an option that is not understood, only --from")
        if len(words) < 2 or any(set(word) & set("*?[") for word in words):
            refuse("has to be names of sources and a destination, without * ? [")
        return source, words[:-1], words[-1]
    if len(words) != 1:
        refuse("has to be one word")
    return words[0]


def parse(text):
    """The stages of a Dockerfile. Throws NotUnderstood, with the number of the line."""
    stages = []
    for line, instruction in instructions(text):
        kind, _, rest = instruction.partition(" ")
        kind, rest = kind.upper(), rest.strip()
        if kind == "FROM":
            match = re.fullmatch(r"(\S+)(?:\s+[Aa][Ss]\s+(\S+))?", rest)
            if not match or rest.startswith("--"):
                raise NotUnderstood(f"line {line}: FROM has to be FROM IMAGE or FROM IMAGE AS STAGE")
            stages.append(Stage(match[2] or str(len(stages)), match[1], []))
            continue
        arguments = arguments_of(line, kind, rest)
        if not stages:
            raise NotUnderstood(f"line {line}: {kind} before the first FROM")
        if kind == "COPY" and arguments[0] is not None and arguments[0] not in [stage.name for stage in stages[:-1]]:
            raise NotUnderstood(f"line {line}: COPY --from={arguments[0]}: there is no such stage before")
        stages[-1].steps.append(Step(line, kind, arguments))
    if not stages:
        raise NotUnderstood("has no FROM")
    return stages
