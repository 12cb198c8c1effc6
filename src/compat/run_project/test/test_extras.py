"""run_project.sh installs only what the project needs."""

import shutil
import subprocess
from pathlib import Path

import pytest

SCRIPT = Path(__file__).resolve().parents[4] / "scripts" / "run_project.sh"
# In place of setup.sh: prints the extras.
SETUP = """
answer_help() { :; }
is_among() { false; }
is_asked_for_web() { false; }
set_up() { printf '%s\\n' "$@"; exit; }
"""


@pytest.mark.parametrize(
    ("file", "text", "extras"),
    [
        ("CMakeLists.txt", "catkin_install_python(PROGRAMS goals.py)\n# add_executable(goals goals.cpp)", []),
        ("CMakeLists.txt", "add_executable(goals goals.cpp)", ["projects"]),
        ("CMakeLists.txt", "  generate_messages(DEPENDENCIES nav_msgs)", ["projects"]),
        ("CMakeLists.txt", "find_package(OpenCV)\nadd_library(eye eye.cpp)", ["projects", "opencv"]),
        ("robot.launch", '<node pkg="joint_state_publisher"/>', ["projects"]),
    ],
)
def test_only_a_project_that_is_compiled_needs_the_libraries_for_cpp(tmp_path, file, text, extras):
    scripts, project = tmp_path / "scripts", tmp_path / "project"
    scripts.mkdir()
    project.mkdir()
    shutil.copy(SCRIPT, scripts)
    (scripts / "setup.sh").write_text(SETUP)
    (project / file).write_text(text)
    for folder, arguments in ((tmp_path, [str(project)]), (project, [])):
        output = subprocess.check_output(
            ["bash", str(scripts / "run_project.sh"), *arguments], text=True, cwd=folder
        )
        assert output.split() == extras
