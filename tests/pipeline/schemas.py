# SPDX-License-Identifier: MIT
"""The JSON schemas of the program's reports and files, and the test that a value follows one."""
import functools
import json
import pathlib

import jsonschema

from shared_models import must

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"
OF_COMMANDS = {
    "accuracy": "accuracy/accuracy", "bake": "bake/bake", "compare": "compare/comparison",
    "decompose": "decompose/decompose", "export": "export/export", "hull": "hull/hull",
    "info": "info/info", "repair": "repair/repair", "validate": "validate/validation"}


@functools.cache
def schema_of(name):
    """A schema of a feature, such as "validate/validation"."""
    return json.loads((TOOLS / f"{name}.schema.json").read_text())


def errors_in(schema, value):
    # No two threads may share a validator.
    return jsonschema.Draft202012Validator(schema).iter_errors(value)


def check_schema(schema, value, what):
    error = jsonschema.exceptions.best_match(errors_in(schema, value))
    if error is not None:
        said = error.message
        said = said if len(said) < 500 else f"{said[:300]} ... {said[-150:]}"
        must(False, f"{what}: at {list(error.absolute_path)}: {said}")


def report_of(command, text):
    """What a command printed as JSON, held to its schema."""
    report = json.loads(text)
    check_schema(schema_of(OF_COMMANDS[command]), report, f"JSON of {command}")
    return report
