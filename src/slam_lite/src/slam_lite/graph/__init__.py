"""The pose graph: optimization, covariance, drift and sparsification."""
