"""One case a file: what it shows in the first line, and run(bench)."""
