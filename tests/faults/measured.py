"""``penink``, its peak memory noted in $MEASURED when it ends."""

import atexit
import os
import resource
import sys


def note() -> None:
    line = f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss} {sys.argv[1]}\n"
    file = os.open(os.environ["MEASURED"], os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o666)
    os.write(file, line.encode())
    os.close(file)


if __name__ == "__main__":
    atexit.register(note)
    from penink_cli.__main__ import main

    main()
