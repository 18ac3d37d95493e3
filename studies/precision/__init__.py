"""What step, integrator, reach and skin do to the error of a run, to statistics, and to the time that a run takes."""
