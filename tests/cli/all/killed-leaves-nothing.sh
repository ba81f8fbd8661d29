# Where the system has files without a name, a tool that is killed while it writes leaves none, for
# each form of output; what was there is as it was.
case $(stat -f -c %T . 2> /dev/null) in
ext* | tmpfs | xfs | btrfs) : ;;
*) echo "no files without a name here, as far as is known"; exit 77 ;;
esac
[ -d /proc/self/fd ] || { echo "no /proc"; exit 77; }
mkdir there
for file in out.tsv out.au out.h5; do
    for old in '' old; do
        [ -z "$old" ] || echo old > there/$file
        mkfifo in
        ss-morlet --stream --fmin 40 -o there/$file < in 2> /dev/null &
        tool=$!
        exec 3> in
        ss-signal noise --duration 8 >&3        # more than a pipe holds: the tool is at work
        ls -A there
        kill -KILL $tool
        { wait $tool || echo "$file: $?"; } 2> /dev/null    # the shell's own words
        exec 3>&-
        [ -z "$old" ] || cat there/$file
        rm -rf in there/*
    done
done
ss-signal sine -o there/new.tsv
ss-signal sine -o there/new.tsv
ss-signal sine | cmp - there/new.tsv
(umask 027; ss-signal sine -o there/mode.au; ss-signal sine -o there/mode.h5)
chmod 604 there/new.tsv
ss-signal sine -o there/new.tsv
stat -c '%a %n' there/*
