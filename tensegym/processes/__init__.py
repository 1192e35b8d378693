"""Work over processes: one way to start workers, to map over them, to keep state in them, and for them to end."""

from .pool import RETRIES, Pool, process_map
from .worker import Worker, WorkerDied, call_all, cores

__all__ = ["RETRIES", "Pool", "Worker", "WorkerDied", "call_all", "cores", "process_map"]
