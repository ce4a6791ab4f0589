"""Runs a Python program of the project in this process: a process of its own would import everything anew."""

import contextlib
import os
import runpy
import sys
import tempfile
import traceback
from subprocess import CompletedProcess
from unittest import mock

STDOUT, STDERR = 1, 2


@contextlib.contextmanager
def _captured(descriptor, name):
    """Collects what Python writes to a stream, and what libraries in C write to its descriptor. Yields a file of it."""
    kept = os.dup(descriptor)
    with tempfile.TemporaryFile("w+", encoding="utf-8") as file:
        os.dup2(file.fileno(), descriptor)
        try:
            with open(descriptor, "w", encoding="utf-8", closefd=False) as stream, mock.patch.object(sys, name, stream):
                yield file
        finally:
            os.dup2(kept, descriptor)
            os.close(kept)


def _exit_status(program):
    """Runs a program and does with what it raises as the interpreter does at the end of a process."""
    try:
        runpy.run_path(program, run_name="__main__")
    except SystemExit as end:
        if isinstance(end.code, int) or end.code is None:
            return end.code or 0
        print(end.code, file=sys.stderr)
        return 1
    except Exception:
        traceback.print_exc()
        return 1
    return 0


def run_here(program, *arguments):
    """Returns its CompletedProcess, as project.run() does."""
    words = [str(word) for word in (program, *arguments)]
    with _captured(STDOUT, "stdout") as out, _captured(STDERR, "stderr") as errors:
        with mock.patch.object(sys, "argv", words), mock.patch.object(sys, "path", list(sys.path)):
            status = _exit_status(words[0])
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
        written = []
        for file in (out, errors):
            file.seek(0)
            written.append(file.read())
    return CompletedProcess(words, status, *written)
