"""What needs the packages of the page, installed when it is first asked for, is tested where they are."""

from importlib.util import find_spec

collect_ignore = [] if find_spec("viser") else ["test_connection_guard.py", "test_page.py"]
