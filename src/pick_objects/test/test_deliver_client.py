import os
import subprocess
import sys

import pytest

pytest.importorskip("rospy")

UNUSED = "http://127.0.0.1:19999"


def test_without_a_master_the_program_reports_it_and_exits(tmp_path):
    mission = tmp_path / "mission.yaml"
    mission.write_text("deliveries: []\n")
    script = "import sys; from pick_objects.ros.deliver_client import main; sys.exit(main(sys.argv))"
    run = subprocess.run(
        [sys.executable, "-c", script, str(mission)],
        env={**os.environ, "ROS_MASTER_URI": UNUSED, "PYTHONPATH": os.pathsep.join(sys.path)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=30,
        check=False,
    )
    assert (run.returncode, run.stdout) == (2, f"error: no ROS master at {UNUSED}\n")
