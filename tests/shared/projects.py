"""Projects that tests have run."""

import shutil
from pathlib import Path

WORK = Path(__file__).resolve().parents[2] / "build/projects"


def remove_work_folder(checkout):
    """What run_project.sh keeps of one."""
    for folder in WORK.glob(f"{checkout.name}-*"):
        shutil.rmtree(folder)
