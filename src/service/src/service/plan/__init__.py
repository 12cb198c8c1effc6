"""Plans over the queue: order, times, charging, and which deadlines cannot be kept."""
