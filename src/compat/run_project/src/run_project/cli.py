"""Command line: read a checkout, build it, run its script, and write the verdict to result.json."""

import fcntl
import hashlib
import os
import re
import sys
import time
from pathlib import Path
from typing import Dict, List, Optional, Sequence, Tuple

from cockpit.process import FREE_PORT, CockpitProcess
from evaluation.preload import preload_nodes
from evaluation.verdict import Verdict
from planar import PlanarError
from run_project.checkout.dry_run import recorded_calls
from run_project.checkout.entry import choose_script, is_home_service_script
from run_project.checkout.layout import Checkout, ProjectError, read_checkout
from run_project.checkout.needs import (
    files_left_to_environment,
    missing_packages,
    navigation_nodes,
    unset_variables,
)
from run_project.checkout.placement import READ_SUFFIXES, Placement, best_placement
from run_project.checkout.vendored import is_vendored
from run_project.course.launch_plan import CourseProject, ProjectLaunchPlan, find_launch_plan
from run_project.judging.log_errors import find_log_errors
from run_project.judging.run_record import ProjectRunRecord
from run_project.judging.verdict import judge
from run_project.options import ProjectOptions, parse
from run_project.preparation.building import (
    DEFAULT_VARIABLES,
    BuildError,
    Workspace,
    build,
    copy_checkout,
    environment,
    is_installed,
)
from run_project.preparation.private_root import private_mount_command
from run_project.ros.headless_rviz import RVIZ_VARIABLE
from run_project.ros.observer import BYSTANDERS
from run_project.ros.project_run import ProjectCommand, ProjectRun
from run_project.ros.scripted_user import PROCEDURES
from run_project.stand_ins import PACKAGE_FOLDER
from run_project.stand_ins.terminal import INPUT_VARIABLE, LOG_FOLDER_VARIABLE
from supervision.display import Display, print_error
from supervision.errors import LaunchError
from supervision.interruption import INTERRUPTED, RunInterruptedError, raise_when_interrupted
from supervision.open_files import check_open_files
from supervision.run_folder import create_run_folder, write_result
from supervision.versions import versions

FAILURE, BAD_INPUT = 1, 2
WORK_FOLDER = PACKAGE_FOLDER.parents[2] / "build" / "projects"
# Windows that programs open directly, as with OpenCV, are rendered off screen.
OFFSCREEN = {"QT_QPA_PLATFORM": "offscreen"}
MAX_TEXT_BYTES = 3_000_000
ROS_FOLDER = re.compile(r"/opt/ros/[a-z]+")
# Simulator parameters for every run: what speed 0 waits for, and odometry without drift, as in Gazebo,
# because many projects compare positions in the map with /odom; at the rate of turtlebot_gazebo's default
# world, whose plugin publishes at each step of 0.01 s.
SIMULATOR_PARAMETERS = {
    "pace_all": True,
    "bystanders": " ".join(BYSTANDERS),
    "odometry_rate": 100,
    "noise": "ideal",
    "range_noise": 0.01,
}
# Seconds that the cockpit stays open after the project has ended.
VIEW_SECONDS = 8.0


def main(arguments: Optional[List[str]] = None) -> int:
    """Run a project.

    Args:
        arguments: Command line without the program's name; None for ``sys.argv``.

    Returns:
        Exit code: 0 success, 1 failure, 2 bad input, 130 interrupted.
    """
    raise_when_interrupted()
    try:
        return run(parse(sys.argv[1:] if arguments is None else arguments))
    except RunInterruptedError as error:
        print_error(str(error))
        return INTERRUPTED
    except (BuildError, LaunchError) as error:
        print_error(str(error))
        return FAILURE
    except PlanarError as error:
        print_error(str(error))
        return BAD_INPUT


def run(options: ProjectOptions) -> int:
    """Build and run the project; returns the exit code."""
    if options.rviz and not os.environ.get("DISPLAY"):
        raise ProjectError("--rviz needs a display, but the environment variable DISPLAY is not set")
    check_open_files()
    started = time.time()
    checkout = read_checkout(options.path)
    with _WorkFolder(checkout.root) as work, Display() as display:
        plan = _launch_plan(checkout, options)
        script = _prepare_script(checkout, options, plan, work.path)
        texts = read_path_texts(checkout, script)
        needs = _lacking(checkout, script, texts[script])
        nodes = navigation_nodes(_own_texts(checkout, texts))
        placement = find_placement(checkout, script, texts, work.path, options.script_arguments)
        folder = create_run_folder(options.output.resolve(), "run_project")
        logs = folder / "log"
        display.print(f"{checkout.root}: {checkout.kind.value}, {len(checkout.packages)} packages in it")
        _warn_about_missing_files(checkout, display)
        for need in needs:
            display.print(f"warning: {need}")
        display.print(f"logs in {logs}")
        workspace = copy_checkout(checkout, placement, work.path)
        prefix = _private_mounts(workspace, placement, texts, work.path)
        if not options.build_only:
            preload_nodes(prefix)
        display.show("building ...")
        build(workspace, logs / "build.log", display.print)
        display.print(f"built in {time.time() - started:.0f} s")
        if options.build_only:
            return 0
        command = _project_command(options, workspace, placement, prefix, script, work.path, logs)
        for target in sorted(placement.mounts):
            display.print(f"provides {target}, for this run alone")
        display.print(f"runs {_script_name(script, plan)}; times are simulated:")
        about = {"project": str(checkout.root), "script": _script_name(script, plan)}
        return run_command(options, command, folder, workspace, display, about, plan, nodes)


def _warn_about_missing_files(checkout: Checkout, display: Display) -> None:
    """Print warnings about files that are missing from the checkout."""
    for lacking, files in (
        ("not fetched, git lfs pull does that", checkout.lfs_pointers()),
        ("maps whose image is not in the checkout", checkout.maps_without_image()),
    ):
        if files:
            display.print(f"warning: {lacking}: {', '.join(files)}")


def _lacking(checkout: Checkout, script: str, text: str) -> List[str]:
    """What a script needs and does not find, in sentences."""
    packages = missing_packages(text, lambda name: name in checkout.packages or is_installed(name))
    variables = unset_variables(text, {*os.environ, *DEFAULT_VARIABLES})
    own = {"world_file": checkout.worlds(), "map_file": list(checkout.maps())}
    defaults = files_left_to_environment(text, own, checkout.own_files(), os.environ)
    return [
        *(
            f"{script} starts a part of {name}, which is neither in the checkout nor here"
            for name in packages
        ),
        *(f"{script} uses ${name}, which is not set: set it as its author has it" for name in variables),
        *(f"{script}: {sentence}" for sentence in defaults),
    ]


def _own_texts(checkout: Checkout, texts: Dict[str, str]) -> List[str]:
    """Scripts, and launch files but for those in copies of public packages."""
    found = []
    for file, text in texts.items():
        package = checkout.package_of(Path(file)) if file.endswith((".launch", ".xml")) else ""
        if package is not None and not is_vendored(package):
            found.append(text)
    return found


def _launch_plan(checkout: Checkout, options: ProjectOptions) -> Optional[ProjectLaunchPlan]:
    """The launch plan of a course project without a script; None if a script is to be run."""
    named = options.script in [project.value for project in CourseProject]
    if not named and (
        options.script is not None or any(is_home_service_script(str(s)) for s in checkout.scripts())
    ):
        return None
    plan = find_launch_plan(checkout.packages, read_path_texts(checkout), options.script)
    if named and plan is None:
        raise ProjectError(f"{checkout.root}: no launch files for the course project {options.script}")
    return plan


def _prepare_script(
    checkout: Checkout, options: ProjectOptions, plan: Optional[ProjectLaunchPlan], work: Path
) -> str:
    """Path of the script, relative to the checkout; for anything else one is generated in ``work``."""
    if plan is None:
        return str(choose_script(checkout, options.script, work))
    made = work / f"{plan.project.value}.sh"
    made.write_text(plan.script())
    made.chmod(0o755)
    return str(made)


def _script_name(script: str, plan: Optional[ProjectLaunchPlan]) -> str:
    if plan is not None:
        return plan.project.value
    return Path(script).name if Path(script).is_absolute() else script


def find_placement(
    checkout: Checkout, script: str, texts: Dict[str, str], work: Path, arguments: Sequence[str]
) -> Placement:
    """Find the placement for which the paths in the checkout's files exist.

    A dry run of the script reveals the paths that it composes from variables; they are appended to its text
    in ``texts``.

    Args:
        checkout: The project.
        script: The script to run, relative to the checkout.
        texts: Contents of files by path, relative to the checkout; the script's entry is extended.
        work: Work folder of the project.
        arguments: Command line arguments of the script.

    Returns:
        Where the checkout is copied to, where the script starts, and which absolute paths are mounted.
    """
    home, user = str(Path.home()), os.environ.get("USER", "root")
    placement = best_placement(checkout, script, texts, home, user)
    copy = copy_checkout(checkout, placement, work)
    recorded = recorded_calls(copy.checkout / script, work / "tree" / placement.start, arguments)
    texts[script] += "\n" + "\n".join(line for line in recorded.splitlines() if str(work) not in line)
    return best_placement(checkout, script, texts, home, user)


def read_path_texts(checkout: Checkout, script: str = "") -> Dict[str, str]:
    """Read the files that may contain paths: path relative to the checkout -> contents."""
    texts = {}
    for file in {*checkout.files, *([script] if script else [])}:
        path = checkout.root / file
        is_text = path.suffix in READ_SUFFIXES or file == script
        if is_text and path.is_file() and path.stat().st_size < MAX_TEXT_BYTES:
            texts[file] = path.read_text(errors="replace")
    return texts


def _private_mounts(
    workspace: Workspace, placement: Placement, texts: Dict[str, str], work: Path
) -> Tuple[str, ...]:
    """Command prefix that provides the absolute paths in the project's files."""
    mounts = {Path(target): work / "tree" / source for target, source in placement.mounts.items()}
    for ros in sorted({found for text in texts.values() for found in ROS_FOLDER.findall(text)}):
        if not Path(ros).exists():
            mounts[Path(ros)] = _ros_distribution_substitute(work / Path(ros).name, workspace)
    root = work / "root"
    root.mkdir(exist_ok=True)
    return tuple(private_mount_command(mounts, root))


def _project_command(
    options: ProjectOptions,
    workspace: Workspace,
    placement: Placement,
    prefix: Tuple[str, ...],
    script: str,
    work: Path,
    logs: Path,
) -> ProjectCommand:
    file = workspace.checkout / script
    shell = [] if file.read_bytes()[:2] == b"#!" else ["bash"]
    command = [*shell, str(file), *options.script_arguments]
    variables = {**environment(workspace), **window_environment(options, logs)}
    return ProjectCommand(command, work / "tree" / placement.start, variables, work, prefix)


def window_environment(options: ProjectOptions, logs: Path) -> Dict[str, str]:
    """Environment variables for programs in terminal windows and for the stand-ins."""
    screen = {RVIZ_VARIABLE: "1"} if options.rviz else OFFSCREEN
    return {LOG_FOLDER_VARIABLE: str(logs), INPUT_VARIABLE: "\n".join(options.type), **screen}


def _ros_distribution_substitute(folder: Path, workspace: Workspace) -> Path:
    """Create the folder mounted as /opt/ros/<distribution>: sourcing it sources the project's workspace."""
    folder.mkdir(exist_ok=True)
    for shell in ("bash", "sh", "zsh"):
        (folder / f"setup.{shell}").write_text(f'. "{workspace.folder}/devel/setup.{shell}"\n')
    return folder


def run_command(
    options: ProjectOptions,
    command: ProjectCommand,
    folder: Path,
    workspace: Workspace,
    display: Display,
    about: Dict[str, str],
    plan: Optional[ProjectLaunchPlan] = None,
    wait_for: Sequence[str] = (),
) -> int:
    """Run the script, judge the run and write result.json.

    Args:
        options: Command line options.
        command: The script with its folder and environment.
        folder: Run folder.
        workspace: The project's built workspace.
        display: Console output.
        about: Entries of result.json that identify the run; ``script`` decides whether goals are required.
        plan: The launch plan if this is a course project without a script.
        wait_for: Nodes of navigation that advance in lock-step with the simulation.

    Returns:
        Exit code: 0 success, 1 failure, 130 interrupted.
    """
    started = time.monotonic()
    parameters = _parameters(options, plan, wait_for)
    run = ProjectRun(command, folder / "log", parameters, display, PROCEDURES[plan.project] if plan else None)
    failure, is_interrupted = None, False
    try:
        with run:
            if options.record:
                run.record(folder / "run.bag")
            failure = _watch_run(run, command, options, folder, display)
    except RunInterruptedError as error:
        failure, is_interrupted = str(error), True
    record = run.observer.record
    verdict = _verdict_of(run, failure, is_home_service_script(about["script"]), options)
    errors = find_log_errors(folder / "log")
    found = {
        "success": verdict.success,
        "reason": verdict.reason,
        **record.findings(),
        "simulated_seconds": round(run.observer.simulated_time, 1),
        "wall_seconds": round(time.monotonic() - started, 1),
        "speed": parameters["/gazebo/speed"],
        "seed": options.seed,
        "left_out": workspace.missing,
        "complaints": errors,
    }
    about = {**about, "command": "run_project"}
    path = write_result(folder, {"versions": versions(), "missing": [], **about, **found})
    _report(display, verdict, record, errors)
    display.print(f"result in {path}, a log of each window in {folder / 'log'}")
    return INTERRUPTED if is_interrupted else 0 if verdict.success else FAILURE


def _verdict_of(
    run: ProjectRun, failure: Optional[str], requires_goals: bool, options: ProjectOptions
) -> Verdict:
    run.observer.record.measure_distances()
    if run.user is None:
        limit = options.timeout if run.is_over_time else None
        return judge(run.observer.record, failure, requires_goals, options.expect, limit)
    return run.user.results.verdict(failure)


def _watch_run(
    run: ProjectRun, command: ProjectCommand, options: ProjectOptions, folder: Path, display: Display
) -> Optional[str]:
    """Watch the run, with the cockpit if requested; returns why the run was cut short, or None."""
    if not options.shows_cockpit:
        return run.watch(options.timeout)
    log = folder / "log" / "cockpit.log"
    cockpit = CockpitProcess(options.web_port or FREE_PORT, log, run.environment(), prefix=command.prefix)
    try:
        display.print(f"cockpit: {cockpit.url}")
        failure = run.watch(options.timeout)
        display.print(f"the cockpit stays open for {VIEW_SECONDS:g} s")
        time.sleep(VIEW_SECONDS)
        return failure
    finally:
        cockpit.close()


def _parameters(
    options: ProjectOptions, plan: Optional[ProjectLaunchPlan], wait_for: Sequence[str]
) -> Dict[str, object]:
    """ROS parameters of the simulator; the project sets all others.

    The scripted user needs real time, so this is the default for course projects.
    """
    speed = options.effective_speed if plan is None or options.speed is not None else 1.0
    return {
        "/gazebo/wait_for": " ".join(wait_for),
        "/use_sim_time": True,
        "/gazebo/speed": speed,
        "/gazebo/seed": options.seed,
        "/gazebo/pace": " ".join(options.pace),
        **{f"/gazebo/{name}": value for name, value in SIMULATOR_PARAMETERS.items()},
    }


def _report(display: Display, verdict: Verdict, record: ProjectRunRecord, errors: List[str]) -> None:
    if not verdict.success:
        for error in errors:
            display.print(f"  | {error}")
    display.print(f"drove {record.distance_driven:.1f} m, {len(record.collisions)} collisions")
    display.print(f"{'SUCCESS' if verdict.success else 'FAILURE'}: {verdict.reason}")


class _WorkFolder:
    """Context that locks the work folder of a checkout, so that only one run uses it."""

    def __init__(self, root: Path):
        name = re.sub(r"[^\w-]", "_", root.name)
        self.path = WORK_FOLDER / f"{name}-{hashlib.sha256(str(root).encode()).hexdigest()[:8]}"

    def __enter__(self):
        self.path.mkdir(parents=True, exist_ok=True)
        self._lock = (self.path / "lock").open("w")
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise ProjectError(f"another run of this project is active; it has locked {self.path}") from None
        return self

    def __exit__(self, *_):
        self._lock.close()
