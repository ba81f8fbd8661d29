#!/bin/sh
# sweep-parallel.sh [-S LOGIN,...] N OPTION ... SCENE > rows.tsv: a sweep in N shards by GNU parallel.
#
# Shards are part1.tsv ... partN.tsv in the present directory; one job a core runs at a time, here or, with
# -S, on other machines by ssh.  Those must see this directory under the same name (NFS and the like)
# and have ss-sweep where it is here.  A job that fails or is killed is started again, up to five times,
# perhaps elsewhere, and goes on where the last one was; so does the whole command when given again.
# Then the rows are written in order.
set -eu
logins=
if [ "${1-}" = -S ]; then
    logins=$2
    shift 2
fi
if [ $# -lt 2 ]; then
    echo "usage: sweep-parallel.sh [-S LOGIN,...] N OPTION ... SCENE > rows.tsv" >&2
    exit 2
fi
shards=$1
shift
seq "$shards" | parallel ${logins:+--sshlogin "$logins"} --workdir "$PWD" --retries 5 --quote \
    "$(command -v ss-sweep)" --quiet --resume 'part{}.tsv' --shard "{}/$shards" "$@"
grep '^#' part1.tsv
seq "$shards" | sed 's/.*/part&.tsv/' | xargs cat | grep -v '^#' | sort -n
