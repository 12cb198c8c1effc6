import pytest

from run_project.checkout.entry import choose_script, readme_commands
from run_project.checkout.layout import CheckoutKind, ProjectError, read_checkout
from run_project.options import parse


def checkout(folder, *files):
    for file in files:
        path = folder / file
        path.parent.mkdir(parents=True, exist_ok=True)
        name = path.parent.name
        path.write_text(f"<package><name>{name}</name></package>" if path.name == "package.xml" else "")
    return read_checkout(folder)


def test_a_folder_with_src_is_a_workspace(tmp_path):
    project = checkout(tmp_path, "src/pick/package.xml", "src/scripts/home_service.sh")
    assert project.kind is CheckoutKind.WORKSPACE
    assert str(project.workspace) == "."
    assert {name: str(folder) for name, folder in project.packages.items()} == {"pick": "src/pick"}


def test_a_workspace_is_found_in_a_folder_of_the_repository(tmp_path):
    project = checkout(
        tmp_path, "catkin_ws/src/pick/package.xml", "catkin_ws/src/mark/package.xml", "README.md"
    )
    assert project.kind is CheckoutKind.WORKSPACE
    assert str(project.workspace) == "catkin_ws"


def test_packages_without_src_above_them_are_the_content_of_src(tmp_path):
    project = checkout(tmp_path, "pick/package.xml", "pick/src/pick.cpp", "mark/package.xml")
    assert project.kind is CheckoutKind.SOURCES
    assert project.workspace is None


def test_a_package_xml_at_the_top_is_one_package(tmp_path):
    assert checkout(tmp_path, "package.xml", "src/pick.cpp").kind is CheckoutKind.PACKAGE


def test_build_folders_are_not_read(tmp_path):
    project = checkout(tmp_path, "src/pick/package.xml", "devel/share/old/package.xml", ".git/x/package.xml")
    assert sorted(project.packages) == ["pick"]


def test_model_folders_are_found(tmp_path):
    project = checkout(
        tmp_path,
        *("src/pick/package.xml", "src/pick/models/chair/model.config", "src/pick/models/table/model.config"),
        "world/House/model.config",
    )
    assert [str(folder) for folder in project.model_folders()] == ["src/pick/models", "world"]


def test_a_folder_without_packages_is_rejected(tmp_path):
    with pytest.raises(ProjectError, match=r"no package\.xml"):
        read_checkout(tmp_path)


def test_an_invalid_package_xml_is_reported(tmp_path):
    (tmp_path / "package.xml").write_text("<package>")
    with pytest.raises(ProjectError, match=r"package\.xml: no element found"):
        read_checkout(tmp_path)


@pytest.mark.parametrize("name", ["home_service.sh", "HomeService.sh", "test_home_service.sh"])
def test_the_home_service_script_is_found(tmp_path, name):
    project = checkout(tmp_path, "src/pick/package.xml", "src/scripts/pick.sh", f"src/scripts/{name}")
    assert choose_script(project, None, tmp_path).name == name


@pytest.mark.parametrize("wanted", ["pick", "pick.sh", "src/scripts/pick.sh"])
def test_another_script_is_selected_by_stem_name_or_path(tmp_path, wanted):
    project = checkout(tmp_path, "src/pick/package.xml", "src/scripts/pick.sh", "src/scripts/home_service.sh")
    assert str(choose_script(project, wanted, tmp_path)) == "src/scripts/pick.sh"


def test_a_missing_script_is_reported_with_the_existing_ones(tmp_path):
    project = checkout(tmp_path, "src/pick/package.xml", "src/scripts/pick.sh")
    with pytest.raises(
        ProjectError,
        match=r"no script home_service\.sh in this checkout; name one of its scripts \(src/scripts/pick",
    ):
        choose_script(project, None, tmp_path)


def test_a_launch_file_is_run_by_a_script_that_is_written(tmp_path):
    project = checkout(tmp_path / "repo", "src/maze/package.xml", "src/maze/launch/race.launch")
    for wanted in ("race", "race.launch", "src/maze/launch/race.launch"):
        script = choose_script(project, wanted, tmp_path)
        assert script.parent == tmp_path
        assert script.read_text() == "#!/bin/sh\nexec roslaunch maze race.launch\n"


def test_a_command_is_run_as_it_is_typed(tmp_path):
    project = checkout(tmp_path / "repo", "src/maze/package.xml")
    script = choose_script(project, "roslaunch maze race.launch gui:='no; x'", tmp_path)
    assert script.read_text() == "#!/bin/sh\nexec roslaunch maze race.launch 'gui:=no; x'\n"


def test_what_a_project_without_scripts_offers_is_proposed(tmp_path):
    project = checkout(
        tmp_path,
        *("src/maze/package.xml", "src/maze/launch/race.launch", "README.md"),
        *("src/gmapping/package.xml", "src/gmapping/launch/demo.launch"),
    )
    (tmp_path / "README.md").write_text(
        "Build it:\n```\n$ catkin_make\n$ roslaunch maze race.launch speed:=2\n```\n"
        "then `roscd`\n    rosrun maze go.py\n"
    )
    with pytest.raises(ProjectError) as refusal:
        choose_script(project, None, tmp_path)
    assert str(refusal.value).endswith(
        "name a launch file (src/maze/launch/race.launch) or a command as its README has it "
        "('roslaunch maze race.launch speed:=2', 'rosrun maze go.py') after the path"
    )
    assert readme_commands(project) == ["roslaunch maze race.launch speed:=2", "rosrun maze go.py"]


def test_a_script_may_follow_an_option():
    assert parse(["path", "--seed", "3", "pick.sh"]).script == "pick.sh"


def test_maps_without_image_are_found(tmp_path):
    checkout(tmp_path, "pick/package.xml", "maps/home.pgm", "old/office.pgm")
    for name, image in (("home", "home.pgm"), ("office", "/home/me/office.pgm"), ("attic", "attic.pgm")):
        (tmp_path / f"maps/{name}.yaml").write_text(f"image: {image}\nresolution: 0.05\norigin: [0, 0, 0]\n")
    (tmp_path / "maps/rviz.yaml").write_text("image: logo.png\n")
    assert read_checkout(tmp_path).maps_without_image() == ["maps/attic.yaml (attic.pgm)"]


def test_git_lfs_pointers_are_found(tmp_path):
    checkout(tmp_path, "pick/package.xml", "world/home.world")
    (tmp_path / "world/map.pgm").write_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\n")
    assert read_checkout(tmp_path).lfs_pointers() == ["world/map.pgm"]
