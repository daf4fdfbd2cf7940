"""The styles that come with the program, a `*.style.json` file each."""
