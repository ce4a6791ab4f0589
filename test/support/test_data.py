"""Finds the datasets that tests use."""

import os
import unittest
from pathlib import Path

from project import SOURCE_DIR


def data_folder():
    """Returns the folder of UAV_LANDING_DATA, or else shared/data beside the project."""
    return Path(os.environ.get("UAV_LANDING_DATA") or SOURCE_DIR.parent / "shared" / "data")


def dataset(name):
    """Returns the folder of a dataset ("lab"). If it is not on this machine, the calling test is skipped and says so."""
    folder = data_folder() / name
    if not folder.is_dir():
        raise unittest.SkipTest(f"no dataset {folder} (set UAV_LANDING_DATA)")
    return folder
