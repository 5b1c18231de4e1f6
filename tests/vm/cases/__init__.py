"""One case in each file: its first line says what it shows; run(bench) runs it."""
