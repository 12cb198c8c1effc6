import os
import shutil

import rospkg

from run_project.stand_ins import STAND_INS, without_stand_ins


def install_rviz(prefix):
    """A program and a package called rviz; returns the program."""
    program, package = prefix / "bin/rviz", prefix / "share/rviz/package.xml"
    for file in (program, package):
        file.parent.mkdir(parents=True)
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    package.write_text("<package><name>rviz</name></package>")
    return program


def test_a_script_does_not_start_a_second_master():
    assert (STAND_INS / "bin/roscore").resolve() == STAND_INS / "bin/harmless"


def test_the_real_rviz_is_found_behind_its_stand_in(tmp_path):
    program = install_rviz(tmp_path)
    during_a_run = {
        "PATH": f"{STAND_INS}/bin:{tmp_path}/bin",
        "ROS_PACKAGE_PATH": f"{STAND_INS}/share:{tmp_path}/share",
        "CMAKE_PREFIX_PATH": f"{tmp_path}/devel:{STAND_INS}:{tmp_path}",
        "HOME": "/home/me",
    }
    shown = without_stand_ins(during_a_run)
    packages = rospkg.RosPack(shown["ROS_PACKAGE_PATH"].split(os.pathsep))
    assert shutil.which("rviz", path=during_a_run["PATH"]) == str(STAND_INS / "bin/rviz")
    assert shutil.which("rviz", path=shown["PATH"]) == str(program)
    assert packages.get_path("rviz") == str(tmp_path / "share/rviz")
    assert shown["CMAKE_PREFIX_PATH"] == f"{tmp_path}/devel:{tmp_path}"
    assert shown["HOME"] == "/home/me"
