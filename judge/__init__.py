"""The one judge of what the robot did, by physics: for the evaluation, the benchmarks and the demonstration."""
