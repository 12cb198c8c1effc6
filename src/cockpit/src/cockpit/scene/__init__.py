"""Visual shapes of worlds and robots, read by a child process."""
