"""Programs that stand in for ours."""


def with_arguments(path, program, *arguments):
    """Writes a program that is another one with further arguments, in the words of a shell."""
    path.write_text(f'#!/bin/sh\nexec "{program}" "$@" {" ".join(arguments)}\n', encoding="utf8")
    path.chmod(0o755)
    return path
