"""From one source folder an assignment's products: kit, public checks, sealed bundle, solution."""

from __future__ import annotations
