"""Statistics of results: confidence intervals, tests and requirements."""
