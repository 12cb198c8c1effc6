"""Skips tests whose packages are installed only on the first use of gymnasium.sh or the cockpit."""

from importlib.util import find_spec

collect_ignore_glob = [] if find_spec("gymnasium") else ["test_*.py"]
if not find_spec("viser"):
    collect_ignore_glob.append("test_window.py")
