"""Inputs, outputs and signals: the one place where penink meets the operating system.

reading (inputs)            a name or standard input
writing (outputs)           a name, whole or not at all, or standard output
  temporary                   files beside the target, renamed at the end
keep_inputs (overwriting)   no output over an input
workbench (bench)           files between filters of one process: reading and writing know their names
install_signals (signals)   INT, TERM and HUP remove the temporary files
descriptors                 what is open already
"""

from penink_cli.ground.streams.bench import on_bench, state, workbench
from penink_cli.ground.streams.descriptors import STDIN, STDOUT, source_name
from penink_cli.ground.streams.inputs import BUFFER, reading
from penink_cli.ground.streams.outputs import Output, flush_text, text_failure, writing
from penink_cli.ground.streams.overwriting import keep_inputs
from penink_cli.ground.streams.signals import install_signals

__all__ = [
    "BUFFER",
    "STDIN",
    "STDOUT",
    "Output",
    "flush_text",
    "install_signals",
    "keep_inputs",
    "on_bench",
    "reading",
    "source_name",
    "state",
    "text_failure",
    "workbench",
    "writing",
]
