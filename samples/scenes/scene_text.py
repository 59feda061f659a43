# SPDX-License-Identifier: MIT
"""The text of scene files that scripts write."""
import json


def text_of(content):
    """JSON with a line for each member, each element of pairs and objects, and each key pose."""
    members = []
    for key, value in content.items():
        text = json.dumps(value)
        if key in ("pairs", "objects"):
            text = "[\n" + ",\n".join("    " + json.dumps(item) for item in value) + "\n  ]"
        members.append(f'  "{key}": {text}')
    text = "{\n" + ",\n".join(members) + "\n}\n"
    return text.replace(' {"time_s"', '\n      {"time_s"').replace('[{"time_s"', '[\n      {"time_s"')
