"""Results of runs: measurement, storage and export."""
