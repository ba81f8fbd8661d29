# A directory, no file, a file that may not be read (root may).
mkdir folder
ss-cat folder || echo $?
ss-cat < folder || echo $?
ss-cat nothing || echo $?
echo > secret
chmod 0 secret
if [ -r secret ]; then
    echo "ss-cat: secret: Permission denied" >&2
    echo 1
else
    ss-cat secret || echo $?
fi
