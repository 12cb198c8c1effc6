"""What evaluate.sh installs when it is first used is not there everywhere."""

from importlib.util import find_spec

NEEDS = {
    "test_campaign.py": "distributed",
    "test_laboratory_page.py": "statsmodels",
    "test_statistics.py": "statsmodels",
}
collect_ignore = [name for name, module in NEEDS.items() if find_spec(module) is None]
