"""Small inputs for every subcommand, and quick processes to run it in."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.faults.calls import make_inputs
from tests.faults.forkserver import ForkServer


@pytest.fixture(scope="session")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the files of CALLS."""
    folder = tmp_path_factory.mktemp("inputs")
    make_inputs(folder)
    return folder


@pytest.fixture(scope="session")
def server() -> Iterator[ForkServer]:
    """Runs ``penink`` in a forked process."""
    server = ForkServer()
    yield server
    server.close()
