"""Options of pytest for all tests."""

import os


def pytest_xdist_auto_num_workers():
    """Returns the number of the processes that run tests: one on each core of this process, not of the machine."""
    return len(os.sched_getaffinity(0))
