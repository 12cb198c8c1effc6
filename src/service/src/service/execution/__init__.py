"""Execution of tasks: steps, activities, orders to the robot."""
