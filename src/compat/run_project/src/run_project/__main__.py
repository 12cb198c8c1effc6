import sys

from supervision.guard import run_guarded
from supervision.interruption import leave

# What a project has started is to end with the run, also if that is killed.
SECONDS_TO_END = 15.0

leave(run_guarded([sys.executable, "-m", "run_project.run", *sys.argv[1:]], SECONDS_TO_END))
