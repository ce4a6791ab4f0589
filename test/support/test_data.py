"""The datasets that tests use, and where they are."""

import os
import unittest
from pathlib import Path

from project import SOURCE_DIR


def data_folder():
    """Environment variable UAV_LANDING_DATA, or shared/data beside the project."""
    return Path(os.environ.get("UAV_LANDING_DATA") or SOURCE_DIR.parent / "shared" / "data")


def dataset(name):
    """Folder of a dataset ("lab"); skips the calling test, saying so, when it is not on this machine."""
    folder = data_folder() / name
    if not folder.is_dir():
        raise unittest.SkipTest(f"no dataset {folder} (set UAV_LANDING_DATA)")
    return folder
