"""Stands for `pierburg diagnose`: answers that nothing is wrong, or as told, and counts how often it was asked."""

import json
import os
import sys
from pathlib import Path

recording, output = Path(sys.argv[-3]), Path(sys.argv[-1])
with Path(os.environ["ASKED"]).open("a") as asked:
    asked.write(f"{recording.name} {sorted(path.name for path in recording.parent.iterdir())}\n")
if os.environ.get("DIAGNOSIS") == "fails":
    sys.exit("cannot tell")
output.mkdir()
answer = {"verdict": "consistent", "effects": [], "parameters": {}, "locations": [], "fit": {}, "ruled_out": []}
answer |= json.loads(os.environ.get("ANSWER", "{}"))
(output / "diagnosis.json").write_text(json.dumps(answer))
(output / "model.yaml").write_text("actuator: pierburg\n")
