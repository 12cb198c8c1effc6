from pathlib import Path

from run_project.checkout.layout import read_checkout
from run_project.checkout.placement import best_placement
from run_project.checkout.substitutes import complete_package
from run_project.preparation.building import copy_checkout

DEMO = "turtlebot_simulator/turtlebot_gazebo/launch/amcl_demo.launch"
SCRIPT = f"xterm -e 'roslaunch ../{DEMO} map_file:=$(pwd)/../map/map.yaml'"


def project(folder, script=SCRIPT):
    for file, text in {
        "pick/package.xml": "<package><name>pick</name></package>",
        "map/map.yaml": "",
        "scripts/home_service.sh": script,
    }.items():
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_text(text)
    return folder


def copied(checkout, work):
    script = "scripts/home_service.sh"
    text = (checkout.root / script).read_text()
    placement = best_placement(checkout, script, {script: text}, "/home/me", "me")
    copy_checkout(checkout, placement, work)
    return placement, work / "tree" / placement.checkout


def test_an_empty_submodule_is_substituted(tmp_path):
    root = project(tmp_path / "repo")
    (root / "turtlebot_simulator").mkdir()
    placement, copy = copied(read_checkout(root), tmp_path / "work")
    assert placement.start == Path("src/scripts")
    assert "amcl" in (copy / DEMO).read_text()
    assert (copy / DEMO).parents[1].joinpath("CATKIN_IGNORE").exists()
    assert list((root / "turtlebot_simulator").iterdir()) == []


def test_a_missing_folder_of_gitmodules_is_substituted(tmp_path):
    root = project(tmp_path / "repo", script="")
    (root / ".gitmodules").write_text('[submodule "a"]\n\tpath = turtlebot_gazebo\n\turl = x\n')
    _, copy = copied(read_checkout(root), tmp_path / "work")
    assert (copy / "turtlebot_gazebo/launch/turtlebot_world.launch").is_file()


def test_a_repository_that_only_the_script_references_is_substituted(tmp_path):
    _, copy = copied(read_checkout(project(tmp_path / "repo")), tmp_path / "work")
    assert (copy / DEMO).is_file()


def test_worlds_and_maps_of_substitutes_are_not_the_projects_own(tmp_path):
    root = project(tmp_path / "repo", script="")
    (root / "turtlebot_gazebo").mkdir()
    (root / "maze.world").write_text("")
    (root / "maze.yaml").write_text("image: maze.pgm\nresolution: 0.05\n")
    read = read_checkout(root)
    assert "turtlebot_gazebo/launch/turtlebot_world.launch" in read.files
    assert "turtlebot_gazebo/launch/turtlebot_world.launch" not in read.own_files()
    assert read.worlds() == ["maze.world"]
    assert read.maps() == {"maze.yaml": "maze.pgm"}


def test_packages_of_the_project_are_kept(tmp_path):
    root = project(tmp_path / "repo")
    (root / DEMO).parent.mkdir(parents=True)
    (root / DEMO).write_text("<launch/>")
    _, copy = copied(read_checkout(root), tmp_path / "work")
    assert (copy / DEMO).read_text() == "<launch/>"


def test_empty_folders_with_other_names_stay_empty(tmp_path):
    root = project(tmp_path / "repo", script="")
    (root / "thirdparty").mkdir()
    assert not read_checkout(root).substitutes


def files_of(folder):
    return {str(file.relative_to(folder)): file.read_text() for file in folder.rglob("*") if file.is_file()}


def write_files(folder, **files):
    for name, text in files.items():
        path = folder / name.replace("__", "/")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder


def test_the_authors_files_in_a_copy_of_a_public_package_win_over_ours(tmp_path):
    his = write_files(tmp_path / "his", launch__maze="his", launch__world="his", urdf="a file")
    ours = write_files(tmp_path / "ours", launch__world="ours", nodes__drive="ours", urdf__robot="ours")
    complete_package(his, ours, replaces_robots=False)
    assert files_of(his) == {
        "launch/maze": "his",
        "launch/world": "his",
        "nodes/drive": "ours",
        "urdf": "a file",
    }
    assert files_of(ours)["launch/world"] == "ours"


def test_robots_that_need_missing_parts_are_replaced(tmp_path):
    his, ours = tmp_path / "his", tmp_path / "ours"
    for folder in (his, ours):
        write_files(folder, **{"urdf__robot.xacro": folder.name, "launch__robot.launch": folder.name})
    complete_package(his, ours, replaces_robots=True)
    assert files_of(his) == {"urdf/robot.xacro": "ours", "launch/robot.launch": "his"}
    assert (ours / "urdf/robot.xacro").read_text() == "ours"
