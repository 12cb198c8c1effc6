"""Actions and services of other nodes, called so that nothing hangs."""
