from pathlib import Path

import pytest

from run_project.checkout.layout import Checkout, CheckoutKind
from run_project.checkout.placement import absolute_paths, best_placement, referenced_paths, resolve_mount


def sources(*files):
    return Checkout(Path("/somewhere/repo"), CheckoutKind.SOURCES, None, {"pick": Path("pick")}, files)


def workspace(folder, *files):
    return Checkout(Path("/somewhere/repo"), CheckoutKind.WORKSPACE, Path(folder), {}, files)


def placed(checkout, script, text):
    return best_placement(checkout, script, {script: text}, home="/home/me", user="me")


FILES = ("pick/package.xml", "world/home.world", "scripts/home_service.sh")


def test_a_checkout_that_was_the_src_of_a_workspace_is_placed_there():
    text = "roslaunch a b world_file:=/home/author/catkin_ws/src/world/home.world"
    placement = placed(sources(*FILES), "scripts/home_service.sh", text)
    assert placement.checkout == Path("src")
    assert placement.mounts == {"/home/author/catkin_ws": Path()}


def test_a_checkout_that_was_cloned_into_src_is_placed_there_under_its_name():
    text = "roslaunch a b world_file:=/home/author/catkin_ws/src/robot/world/home.world"
    placement = placed(sources(*FILES), "scripts/home_service.sh", text)
    assert placement.checkout == Path("src/robot")
    assert placement.mounts == {"/home/author/catkin_ws": Path()}


@pytest.mark.parametrize(
    ("own", "checkout"),
    [
        ('WS="$( cd "$( dirname "${BASH_SOURCE[0]}" )/../../.." >/dev/null && pwd )"', "src/repo"),
        ('WS=$( cd $(dirname "$0")/../../; pwd -P )', "src"),
    ],
)
def test_the_depth_of_the_checkout_follows_from_paths_relative_to_the_script(own, checkout):
    text = f"{own}\nsource $WS/devel/setup.bash\n"
    assert placed(sources(*FILES), "scripts/home_service.sh", text).checkout == Path(checkout)


def test_home_folder_and_user_name_are_expanded():
    text = "source ~/catkin_ws/devel/setup.bash; cat /home/$USER/ws2/src/world/home.world"
    mounts = placed(sources(*FILES), "scripts/home_service.sh", text).mounts
    assert mounts == {"/home/me/catkin_ws": Path(), "/home/me/ws2": Path()}


@pytest.mark.parametrize(
    ("home", "line"),
    [
        ("/home/workspace", 'ws=/home/workspace\nxterm -e "cd ${ws} && source devel/setup.bash && go" &'),
        ("/home/me/catkin_ws", 'xterm -e " cd ~/catkin_ws; source devel/setup.bash; roslaunch a b.launch" &'),
        ("/home/me/catkin_ws", "cd $HOME/catkin_ws/src\nrosrun rviz rviz -d world/home.world"),
    ],
)
def test_a_folder_that_a_script_changes_to_is_mounted_by_the_files_it_expects_there(home, line):
    assert placed(sources(*FILES), "scripts/home_service.sh", line).mounts == {home: Path()}


def test_a_folder_without_expected_files_is_not_mounted():
    text = "cd /home/me/elsewhere && ls other/notes.txt; cd /usr/share && cat doc/README.md"
    assert placed(sources(*FILES), "scripts/home_service.sh", text).mounts == {}


def test_a_workspace_below_the_repository_stays_there():
    checkout = workspace("catkin_ws", "catkin_ws/src/world/home.world", "catkin_ws/src/go.sh")
    placement = placed(checkout, "catkin_ws/src/go.sh", "cat /home/workspace/catkin_ws/src/world/home.world")
    assert placement.workspace == Path("catkin_ws")
    assert placement.mounts == {"/home/workspace": Path()}


@pytest.mark.parametrize(
    ("text", "start"),
    [
        ('xterm -e "source devel/setup.bash && rosrun a b" &', "."),
        ("SRC=`pwd`\nWORLD=${SRC}/src/world/home.world", "."),
        ('xterm -e "cd $(pwd)/../.. ; source devel/setup.bash" &', "src/scripts"),
        ("cd ../..\nxterm -e 'roslaunch a b world_file:=$(pwd)/src/world/home.world'", "src/scripts"),
        ("cd $(pwd)/../..\nroot=$(pwd)\nxterm -e 'source ${root}/devel/setup.bash'", "src/scripts"),
        ("xterm -e 'cd ..; cd world/; roslaunch home.launch'", "src/scripts"),
        ('xterm -e " roslaunch a b world_file:="$PWD"/src/world/home.world " &', "."),
        ("rosparam load scripts/../world/home.world", "src"),
    ],
)
def test_a_script_starts_where_the_files_it_references_exist(text, start):
    assert placed(sources(*FILES), "scripts/home_service.sh", text).start == Path(start)


def test_rospack_find_is_resolved():
    named = set(referenced_paths("cat $(rospack find pick)/../world/x", "/@", "/@", {"pick": "/@/src/pick"}))
    assert named == {"/@/src/world/x"}


def test_comments_are_ignored():
    assert not list(referenced_paths("# cd x/y; cat a/b", "/@", "/@", {}))


@pytest.mark.parametrize(
    "path", ["/gazebo/set_model_state", "/opt/ros/kinetic/setup.bash", "/usr/lib/ros/a.sh"]
)
def test_topics_and_system_files_are_not_paths_of_the_project(path):
    assert absolute_paths(f"cat {path}; curl http://a/b/c.d", "/home/me", "me") == set()


def test_a_path_below_a_mount_is_resolved_to_its_source():
    mounts = {"/home/author/ws": Path()}
    assert resolve_mount("/home/author/ws/src/a", mounts) == Path("src/a")
    assert resolve_mount("/home/author/ws2/src/a", mounts) is None


MAP = "image: {}\nresolution: 0.05\n"


@pytest.mark.parametrize(
    ("named", "mounts", "links"),
    [
        ("/home/author/map.pgm", {"/home/author/map.pgm": Path("src/maps/map.pgm")}, {}),
        ("/home/author/ws/src/old/map.pgm", {}, {Path("src/old/map.pgm"): Path("src/maps/map.pgm")}),
        ("/home/author/ws/src/maps/map.pgm", {}, {}),
        ("/home/author/other.pgm", {}, {}),
    ],
)
def test_a_moved_map_image_is_found_beside_its_map(named, mounts, links):
    script = "scripts/home_service.sh"
    texts = {script: "cat /home/author/ws/src/maps/map.yaml", "maps/map.yaml": MAP.format(named)}
    checkout = sources(*FILES, "maps/map.yaml", "maps/map.pgm", "old_maps/map.pgm")
    placement = best_placement(checkout, script, texts, home="/home/me", user="me")
    assert placement.mounts == {"/home/author/ws": Path(), **mounts}
    assert placement.links == links
