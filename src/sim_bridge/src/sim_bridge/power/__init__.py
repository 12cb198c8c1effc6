"""Power of a robot: its battery, its loads, and the dock that charges it."""
