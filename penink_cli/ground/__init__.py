"""What all rooms stand on: values, errors, units, papers, threads, streams, what a printer adds to a stroke."""
