"""The files for containers and for CI name what is there; no engine reads them here."""

import re
import shlex
import subprocess
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
DOCKERFILE = ROOT / "docker/Dockerfile"
WORKFLOW = ROOT / ".github/workflows/ci.yaml"
OPTION = re.compile(r"--[a-z][a-z-]*")


def dockerfile():
    """Return the instructions, one per line."""
    text = re.sub(r"^\s*#.*\n", "", DOCKERFILE.read_text(), flags=re.MULTILINE)
    return text.replace("\\\n", " ").splitlines()


def options_of(script):
    usage = subprocess.run([ROOT / script, "--help"], check=True, capture_output=True, text=True).stdout
    return set(OPTION.findall(usage))


def test_everything_that_is_copied_into_the_image_is_there():
    for line in dockerfile():
        words = line.split()
        if words[:1] == ["COPY"] and not any(word.startswith("--from") for word in words):
            for source in words[1:-1]:
                assert list(ROOT.glob(source)), f"{line}: no {source}"


def test_compose_builds_targets_that_the_dockerfile_has():
    targets = {
        words[3] for words in map(str.split, dockerfile()) if words[:1] == ["FROM"] and len(words) == 4
    }
    compose = ROOT / "docker/compose.yaml"
    services = yaml.safe_load(compose.read_text())["services"]
    assert set(services) == {"robot", "rviz", "cockpit"}
    for name, service in services.items():
        build = service["build"]
        context = (compose.parent / build["context"]).resolve()
        assert context == ROOT
        assert (context / build["dockerfile"]).resolve() == DOCKERFILE
        assert build.get("target", "robot") in targets
        assert service["read_only"]
        assert service["network_mode"] == ("host" if name == "cockpit" else "none")
        assert service.get("profiles", ["robot"]) == [name]


def test_what_the_image_starts_is_there():
    text = "\n".join(dockerfile())
    starts = [
        yaml.safe_load(found) for found in re.findall(r"^(?:CMD|ENTRYPOINT) (\[.*\])$", text, re.MULTILINE)
    ]
    (entrypoint,) = (start for start in starts if start[0].endswith("entrypoint.sh"))
    assert (ROOT / Path(*entrypoint[0].split("/")[3:])).exists()
    for command, *options in (start for start in starts if start is not entrypoint):
        assert set(options) <= options_of(f"scripts/{command}.sh")


@pytest.mark.skipif(not WORKFLOW.exists(), reason="the image is built without the workflow")
def test_the_workflow_runs_scripts_with_options_that_they_have():
    jobs = yaml.safe_load(WORKFLOW.read_text())["jobs"]
    steps = [step for job in jobs.values() for step in job["steps"]]
    for step in steps:
        assert ("uses" in step) != ("run" in step), step
        assert (ROOT / step.get("with", {}).get("file", ".")).exists()
    commands = [
        line for step in steps if "run" in step for line in step["run"].replace("\\\n", " ").splitlines()
    ]
    assert ".ci/run" in commands
    for words in map(shlex.split, commands):
        if words[0].startswith((".ci/", "./scripts/")):
            assert (ROOT / words[0]).exists()
            assert set(OPTION.findall(" ".join(words[1:]))) <= (
                options_of(words[0]) if len(words) > 1 else set()
            )
        if words[:2] == ["docker", "run"]:
            of_command = words[words.index("home-service-robot") + 1 :]
            assert set(OPTION.findall(" ".join(of_command))) <= options_of("scripts/home_service.sh")
