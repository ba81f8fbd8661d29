#!/bin/sh
# run.sh: what `make check-cluster` does: the parallel and Slurm examples under tools/, for real.
#
# GNU parallel works over ssh to an sshd of its own, on the loopback with throwaway keys; Slurm is one
# machine with munged, slurmctld and slurmd of its own.  All live in a scratch directory and end with it.
# In each, a worker is killed in the middle of its shard.  Debian: parallel openssh-server slurm-wlm munge.
set -u
SRC=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/stickslip-cluster.XXXXXX") || exit 1
PATH=$PATH:/usr/sbin
failed=0
pids=

finish() {
    for pid in $pids; do kill "$pid" 2> /dev/null; done
    # shellcheck disable=SC2086  # a list
    [ -z "$pids" ] || wait $pids 2> /dev/null
    [ "$failed" != 0 ] || rm -rf "$work"
}
trap finish EXIT
trap 'exit 130' HUP INT TERM

missing() {     # PROGRAM ...: the first that is not there
    for program; do
        command -v "$program" > /dev/null || { echo "$program"; return 0; }
    done
    return 1
}

say() { echo "$1: $2"; }

fail() {
    say "$1" "FAILED, $2; see $work"
    failed=1
}

wait_for() {    # SECONDS COMMAND ...: until it succeeds
    tries=$(($1 * 10))
    shift
    until "$@" > /dev/null 2>&1; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || return 1
        sleep 0.1
    done
}

free_port() {   # one that nothing listens at
    port=$((20000 + $$ % 20000))
    while grep -qi ":$(printf %04X "$port") " /proc/net/tcp /proc/net/tcp6; do port=$((port + 1)); done
    echo "$port"
}

# A stand-in for ss-sweep that says who it is, so that the right process is killed.
sweep=$(command -v ss-sweep) || { echo "no ss-sweep in PATH"; exit 1; }
mkdir "$work/bin"
cat > "$work/bin/ss-sweep" << EOF
#!/bin/sh
for word; do case \$word in part*.tsv) echo \$\$ >> "\${word%.tsv}.pids" ;; esac; done
exec "$sweep" "\$@"
EOF
chmod +x "$work/bin/ss-sweep"

SHARDS=4
grid() { "$@" --measure stops,amplitude,energy --vary friction=0.6:1.2:32000 coulomb; }

rows() { grep -vc '^#' "$1"; }
has_rows() { [ "$(rows "$1")" -ge "$2" ]; }

# Kill the worker of a shard in the middle of it; how many rows it had.
kill_worker() {
    wait_for 60 has_rows "$1/part2.tsv" 500 || return 1
    kill -9 "$(tail -n 1 "$1/part2.pids")" || return 1
    had=$(rows "$1/part2.tsv")
    [ "$had" -lt 8000 ]
}

grid "$sweep" > "$work/whole.tsv" || exit 1

# --- GNU parallel ------------------------------------------------------------------------------

parallel_over_ssh() {
    dir=$work/parallel
    mkdir -p "$dir/home" && cd "$dir" || return
    port=$(free_port)
    ssh-keygen -q -t ed25519 -N '' -f host_key && ssh-keygen -q -t ed25519 -N '' -f user_key || return
    cp user_key.pub authorized_keys
    cat > sshd_config << EOF
Port $port
ListenAddress 127.0.0.1
HostKey $dir/host_key
PidFile $dir/sshd.pid
AuthorizedKeysFile $dir/authorized_keys
StrictModes no
UsePAM no
PasswordAuthentication no
KbdInteractiveAuthentication no
PermitRootLogin prohibit-password
MaxStartups 100
EOF
    cat > ssh_config << EOF
Host worker
    HostName 127.0.0.1
    Port $port
    User $(id -un)
    IdentityFile $dir/user_key
    IdentitiesOnly yes
    StrictHostKeyChecking no
    UserKnownHostsFile $dir/known_hosts
    LogLevel ERROR
EOF
    [ "$(id -u)" != 0 ] || mkdir -p /run/sshd
    "$(command -v sshd)" -D -f sshd_config -E sshd.log &
    pids="$pids $!"
    wait_for 20 ssh -F ssh_config worker true || { fail parallel "no ssh to the sshd"; return; }
    (
        export PATH="$work/bin:$PATH" HOME="$dir/home"
        mkdir -p "$HOME/.parallel" && : > "$HOME/.parallel/will-cite"
        grid sh "$SRC/tools/sweep-parallel.sh" -S "2/ssh -F $dir/ssh_config worker" $SHARDS
    ) > rows.tsv 2> log &
    job=$!
    kill_worker "$dir" || fail parallel "no worker to kill in mid-sweep"
    wait $job || fail parallel "exit status $?"
    cmp rows.tsv "$work/whole.tsv" || { fail parallel "other rows than one process"; return; }
    [ "$(wc -l < part2.pids)" -ge 2 ] || fail parallel "the killed worker was not started again"
    say parallel "$SHARDS shards over ssh, worker killed at row $had of 8000 and started again, same rows"
}

# --- Slurm -------------------------------------------------------------------------------------

start_slurm() {
    host=$(hostname -s)
    port=$(free_port)
    head -c 1024 /dev/urandom > munge.key && chmod 600 munge.key
    mkdir state spool munge && chmod 755 "$work" "$dir" munge
    munged --force --foreground --key-file="$dir/munge.key" --socket="$dir/munge/socket" \
        --pid-file="$dir/munge/pid" --log-file="$dir/munge.log" --seed-file="$dir/munge.seed" \
        > munged.out 2>&1 &
    pids="$pids $!"
    cat > slurm.conf << EOF
ClusterName=stickslip
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$((port + 1))
SlurmdPort=$((port + 2))
AuthType=auth/munge
AuthInfo=socket=$dir/munge/socket
CredType=cred/munge
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(getconf _NPROCESSORS_ONLN) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
EOF
    wait_for 10 test -S munge/socket || return 1
    slurmctld -D -f "$dir/slurm.conf" > slurmctld.out 2>&1 &
    pids="$pids $!"
    slurmd -D -f "$dir/slurm.conf" > slurmd.out 2>&1 &
    pids="$pids $!"
    wait_for 60 sh -c 'sinfo -h -o %T | grep -q idle'
}

slurm_array() {
    dir=$work/slurm
    mkdir "$dir" && cd "$dir" || return
    export SLURM_CONF="$dir/slurm.conf"
    start_slurm || { fail slurm "it does not start"; return; }
    PATH=$work/bin:$PATH
    export PATH
    job=$(grid sbatch --parsable --array=1-$SHARDS "$SRC/tools/sweep.sbatch") ||
        { fail slurm "sbatch: exit status $?"; return; }
    kill_worker "$dir" || fail slurm "no worker to kill in mid-sweep"
    wait_for 120 sh -c "[ -z \"\$(squeue -h -j $job 2> /dev/null)\" ]" ||
        { fail slurm "the array does not end"; return; }
    (grep '^#' part1.tsv; cat part*.tsv | grep -v '^#' | sort -n) > rows.tsv
    cmp rows.tsv "$work/whole.tsv" || { fail slurm "other rows than one process"; return; }
    [ "$(wc -l < part2.pids)" -ge 2 ] || fail slurm "the killed worker was not started again"
    say slurm "array of $SHARDS tasks, worker killed at row $had of 8000 and started again, same rows"
}

if lacks=$(missing parallel sshd ssh ssh-keygen); then
    say parallel "skipped, no $lacks"
else
    parallel_over_ssh
fi
if lacks=$(missing munged slurmctld slurmd sbatch); then
    say slurm "skipped, no $lacks"
elif [ "$(id -u)" != 0 ]; then
    say slurm "skipped, slurmd wants root"
else
    slurm_array
fi
exit $failed
