"""validate_scenes.py SCHEMA SEQUENCE: validates each scene of a JSON text sequence (RFC 7464: before each a record
separator) by a JSON Schema, and prints a line for each: nothing where it is valid, otherwise what the schema refuses."""
import json
import sys

from jsonschema import Draft7Validator


def refuse(word):
    raise ValueError(f"{word} is not JSON")


def problem(validator, text):
    errors = validator.iter_errors(json.loads(text, parse_constant=refuse))
    return next((f"{'/'.join(map(str, e.absolute_path))}: {e.validator}" for e in errors), "")


with open(sys.argv[1], encoding="utf-8") as file:
    schema = json.load(file)
Draft7Validator.check_schema(schema)
with open(sys.argv[2], encoding="utf-8", newline="") as file:
    for scene in file.read().split("\x1e")[1:]:
        print(problem(Draft7Validator(schema), scene))
