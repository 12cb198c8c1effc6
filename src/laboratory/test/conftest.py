"""Skips tests whose packages are installed only on the first use of evaluate.sh and the like."""

from importlib.util import find_spec

NEEDS = {
    "test_campaign.py": "distributed",
    "test_laboratory_page.py": "statsmodels",
    "test_search.py": "optuna",
    "test_statistics.py": "statsmodels",
}
collect_ignore = [name for name, module in NEEDS.items() if find_spec(module) is None]
