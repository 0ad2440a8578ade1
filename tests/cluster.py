"""Cluster: a Dask cluster on this machine that takes ports that are free."""

import distributed


def make_cluster(**options):
    """Return a cluster with one thread a worker.

    Without an address of the dashboard its scheduler asks for port 8787, and warns where another one has it: that is an
    error in tests.
    """
    return distributed.LocalCluster(threads_per_worker=1, dashboard_address="127.0.0.1:0", **options)
