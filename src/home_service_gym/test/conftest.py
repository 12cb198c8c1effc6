"""What gymnasium.sh installs when it is first used is not there everywhere."""

from importlib.util import find_spec

collect_ignore_glob = [] if find_spec("gymnasium") else ["test_*.py"]
