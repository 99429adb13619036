"""Slurm on this machine alone, for as long as a test needs it: keys, state and ports of its own, and nothing of the system's."""
import contextlib
import os
import shutil
import socket
import subprocess
import tempfile
import time
import unittest

PROGRAMS = ('munged', 'slurmctld', 'slurmd', 'sbatch')
SETTINGS = '''ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge.socket
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}
SlurmdSpoolDir={folder}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
ReturnToService=2
SelectType=select/cons_tres
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
'''


def installed():
    return all(shutil.which(program) for program in PROGRAMS)


def free_ports(count):
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for one in sockets:
            one.bind(('127.0.0.1', 0))
        return [one.getsockname()[1] for one in sockets]


@contextlib.contextmanager
def controller(patience=60.0):
    """Sets SLURM_CONF to one that answers. SkipTest where none does within `patience` seconds."""
    folder = tempfile.mkdtemp()
    settings = os.path.join(folder, 'slurm.conf')
    with open(settings, 'w') as file:
        file.write(SETTINGS.format(host=socket.gethostname().split('.')[0], ports=free_ports(2), folder=folder,
                                   user=subprocess.check_output(['id', '-un'], text=True).strip(), cpus=os.cpu_count()))
    key = os.path.join(folder, 'munge.key')
    with open(os.open(key, os.O_CREAT | os.O_WRONLY, 0o600), 'wb') as file:
        file.write(os.urandom(128))
    os.environ['SLURM_CONF'] = settings
    munge = ['munged', '--foreground', '--force', '--socket=' + folder + '/munge.socket', '--key-file=' + key,
             '--pid-file=' + folder + '/munged.pid', '--log-file=' + folder + '/munged.log', '--seed-file=' + folder + '/munge.seed']
    daemons = []
    try:
        for command in (munge, ['slurmctld', '-D'], ['slurmd', '-D']):
            with open(os.path.join(folder, command[0] + '.out'), 'w') as out:
                daemons.append(subprocess.Popen(command, stdout=out, stderr=out))
        until = time.monotonic() + patience
        while subprocess.run(['sinfo', '-h', '-t', 'idle', '-o', '%t'], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                             text=True).stdout.strip() != 'idle':
            if time.monotonic() > until:
                raise unittest.SkipTest('Slurm does not answer; its messages: ' + ''.join(
                    open(os.path.join(folder, name)).read() for name in sorted(os.listdir(folder)) if name.endswith('.out')))
            time.sleep(0.2)
        yield
    finally:
        for daemon in reversed(daemons):
            daemon.terminate()
        for daemon in daemons:
            daemon.wait()
        del os.environ['SLURM_CONF']
        shutil.rmtree(folder, ignore_errors=True)
