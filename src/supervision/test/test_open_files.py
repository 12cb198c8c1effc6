import os
import subprocess
import sys

import pytest

SCRIPT = """
import resource
resource.setrlimit(resource.RLIMIT_NOFILE, ({soft}, {hard}))
from supervision.open_files import check_open_files
check_open_files()
print(*resource.getrlimit(resource.RLIMIT_NOFILE))
"""


def limits_after(soft, hard):
    """What is allowed after the check, or what it raises; runs in a separate process."""
    run = subprocess.run(
        [sys.executable, "-c", SCRIPT.format(soft=soft, hard=hard)],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        timeout=20.0,
        check=False,
    )
    return run.stdout.strip() or run.stderr.splitlines()[-1]


@pytest.mark.parametrize(
    "before, after",
    [((64, 2000), "1024 2000"), ((64, 512), "512 512"), ((1500, 2000), "1500 2000"), ((256, 256), "256 256")],
)
def test_a_low_limit_is_raised_as_far_as_the_system_lets_it(before, after):
    assert limits_after(*before) == after


@pytest.mark.parametrize("hard", [64, 128, 255])
def test_a_limit_that_is_too_low_is_refused(hard):
    complaint = f"the limit of open files is {hard} (ulimit -n), but the nodes need 256"
    assert limits_after(hard // 2, hard).endswith(complaint)
