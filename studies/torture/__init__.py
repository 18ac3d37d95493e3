"""What a sweep must live through: kills, lost machines, many runs."""
