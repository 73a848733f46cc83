#!/usr/bin/env python3
"""eyebox.measure from a checkout, without installing the package."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from eyebox.measure import main  # noqa: E402  found through the line above

sys.exit(main())
