import sys

from supervision.guard import run_guarded
from supervision.interruption import leave

# Wall time that processes started by the project get to end when the run ends or is killed.
SECONDS_TO_END = 15.0

leave(run_guarded([sys.executable, "-m", "run_project.run", *sys.argv[1:]], SECONDS_TO_END))
