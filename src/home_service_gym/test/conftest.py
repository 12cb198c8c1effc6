"""What gymnasium.sh, and the cockpit, install when they are first used is not there everywhere."""

from importlib.util import find_spec

collect_ignore_glob = [] if find_spec("gymnasium") else ["test_*.py"]
if not find_spec("viser"):
    collect_ignore_glob.append("test_window.py")
