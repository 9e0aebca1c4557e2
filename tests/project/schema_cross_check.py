"""Cross-checks the JSON Schemas with the program's own reader, by an independent validator.

Usage: schema_cross_check.py PROBE SOURCE_TREE

Every value of full documents is replaced by values of every kind, removed, or given a stranger; for each of these
documents the schema and the reader must agree whether it is valid. What only a reader can know (limits between two keys)
is listed in BEYOND_SCHEMAS with a pattern of its message. The files of the source tree must be valid too.
"""
import copy
import json
import pathlib
import re
import subprocess
import sys

import jsonschema

SCENES = [{"builtin": "half_plane", "blocker_height": 0.5}, {"builtin": "strips"}, {"builtin": "square"},
          {"builtin": "sphere_grid", "count": 7}, {"builtin": "pillars"}, {"builtin": "layers"},
          {"builtin": "animated", "move": {"a": [1, 2, 3]}, "time": 1.5},
          {"file": "x.glb"}, {"file": "x.glb", "cast": ["a"], "receive": [], "move": {"b": [0, 0.5, -1]}, "time": 0},
          [{"builtin": "strips"}, {"file": "x.glb"}]]

LIGHTS = [{"type": "spot", "position": [6, 10, 4], "target": [0, 0, 0], "cone_half_angle_degrees": 30,
           "source": {"shape": "rectangle", "size": [1, 1], "roll_degrees": 0}},
          {"type": "directional", "position": [6, 10, 4], "target": [0, 0, 0], "angular_diameter_degrees": 0.5},
          {"type": "point", "position": [6, 10, 4], "radius": 0.5}]

CAMERAS = [{"type": "perspective", "position": [0, 9, 14], "vertical_fov_degrees": 45},
           {"type": "orthographic", "position": [0, 9, 14], "height": 5}]

RUN = {"$schema": "schema/run.schema.json", "name": "x", "scene": {"builtin": "sphere_grid", "count": 7},
       "plan": {"penumbra": "off", "culling": "auto", "without": ["min_variance"]},
       "camera": {"position": [0, 9, 14], "target": [0, 0, 0], "vertical_fov_degrees": 45},
       "lights": [LIGHTS[0]],
       "output": {"size": [800, 600], "images": ["shaded", "error"]},
       "reference": {"technique": "r", "parameters": {"samples": 4}}, "baseline": {"technique": "s"},
       "techniques": [{"technique": "s", "sweep": {"m": [1, 2]}}, {"technique": "p", "parameters": {"k": "b"}}],
       "measure": {"regimes": ["dynamic"], "frames": 30, "blocks": 2}}

TECHNIQUE = {"$schema": "technique.schema.json", "library": "l",
             "techniques": {"a": {"title": "t", "entry": "e"},
                            "b": {"title": "t", "entry": "e", "role": "floor", "parameters": {"x": 1}},
                            "c": {"title": "t", "compose": {"projection": "p", "representation": "r", "footprint": "f"}}},
             "components": {"d": {"title": "t", "axis": "footprint"}}}

# A technique's parameters of every kind, with all that a range may say.
PARAMETERS = {"on": True, "taps": 5, "odd": 7, "tile": 128, "level": 0.5, "threshold": 1e-4, "kernel": "gaussian",
              "size": [64, 128], "odd_size": 3, "bias.slope": 1.5}

VALUES = [None, True, False, 0, -1, 1, 2, 3.0, 4.0, 0.5, 63, 64, 64.0, 100, 192, 90, 91, 179.5, 180, 16384, 16385, 1e10, 1e-9, "", "x", "on", "pcf", "Spot",
          "../l", [], [1], [1, 2], [1, 2, 3], [1, 2, 3, 4], [3, 5], [64, 64], [64, 65], [2.0, 4], ["a", "a"], ["shaded", "shaded"], ["shaded"], {}, {"a": 1},
          {"seed": 1}, {"seed": [1]}, {"m": []}, {"m": [1, 1.0]}, {"m": 1}, [{}], [{"technique": "x"}]]

# A document that only the reader refuses, by what it says.
BEYOND_SCHEMAS = [r"is also set in parameters"]

FILES = {"run": "configs/*.json", "technique": "plugins/*/*.json"}

REMOVED = object()
STRANGER = object()


def paths(value, path=()):
    yield path
    children = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else []
    for key, child in children:
        yield from paths(child, path + (key,))


def changed(document, path, value):
    """A copy with one value replaced, removed, or given a key that nobody knows; None where that cannot be."""
    if not path and value is not STRANGER:
        return None if value is REMOVED else value
    result = copy.deepcopy(document)
    at = result
    for key in path[:-1] if value is not STRANGER else path:
        at = at[key]
    if value is STRANGER:
        if not isinstance(at, dict):
            return None
        at["zzz"] = 1
    elif value is REMOVED:
        del at[path[-1]]
    else:
        at[path[-1]] = value
    return result


def documents(whole):
    for path in list(paths(whole)):
        for value in VALUES + [REMOVED, STRANGER]:
            document = changed(whole, path, value)
            if document is not None:
                yield document


def variants():
    """Every kind of scene, light and camera, each with its own keys changed."""
    for part, kinds in (("scene", SCENES), ("lights", [[light] for light in LIGHTS]), ("camera", CAMERAS)):
        for kind in kinds:
            for changed_kind in documents(kind):
                yield {**RUN, part: changed_kind}


def check(probe, kind, schema, docs):
    """Numbers of documents, of valid ones, and the disagreements."""
    validator = jsonschema.Draft202012Validator(schema)
    lines = "".join(f"{kind} {json.dumps(document)}\n" for document in docs)
    answers = subprocess.run([probe], input=lines, capture_output=True, text=True, check=True).stdout.split("\n")[:-1]
    if len(answers) != len(docs):
        raise SystemExit(f"{len(docs)} documents, {len(answers)} answers")
    disagreements = []
    for document, answer in zip(docs, answers):
        said = [problem for problem in answer.split(" | ") if problem]
        faults = [error.message for error in validator.iter_errors(document)]
        if bool(said) == bool(faults):
            continue
        if not faults and all(any(re.search(p, problem) for p in BEYOND_SCHEMAS) for problem in said):
            continue
        disagreements.append(f"{json.dumps(document)}\n    reader: {said or 'valid'}\n    schema: {faults[:2] or 'valid'}")
    return len(docs), sum(not answer for answer in answers), disagreements


def main():
    probe, tree = sys.argv[1], pathlib.Path(sys.argv[2])
    failed = False
    for kind, whole, more in (("run", RUN, list(variants())), ("technique", TECHNIQUE, []), ("parameters", PARAMETERS, [])):
        schema = json.loads(subprocess.check_output([probe, "schema", kind]))
        jsonschema.Draft202012Validator.check_schema(schema)
        files = sorted(tree.glob(FILES[kind])) if kind in FILES else []
        if kind in FILES and not files:
            raise SystemExit(f"{tree} has no files of the kind {kind}")
        validator = jsonschema.Draft202012Validator(schema)
        for file in files:
            for error in validator.iter_errors(json.loads(file.read_text())):
                failed = True
                print(f"{file}: {error.json_path}: {error.message}")
        count, valid, disagreements = check(probe, kind, schema, [whole] + list(documents(whole)) + more)
        print(f"{kind}: {len(files)} files, {count} documents, {valid} of them valid, {len(disagreements)} disagreements")
        for disagreement in disagreements[:20]:
            print("  " + disagreement)
        failed = failed or bool(disagreements) or not 0 < valid < count
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
