"""Work folders of projects run by tests."""

import shutil
from pathlib import Path

WORK = Path(__file__).resolve().parents[2] / "build/projects"


def remove_work_folder(checkout):
    """Remove the work folder that run_project.sh keeps for a checkout."""
    for folder in WORK.glob(f"{checkout.name}-*"):
        shutil.rmtree(folder)
