"""What a command needs around its run: a supervised graph, a run folder, Ctrl-C, the terminal."""
