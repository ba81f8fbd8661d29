# --time names a dataset of time in files of h5py, MATLAB and netCDF, in every tool that reads a signal.
python=${PYTHON:-python3}
"$python" -c 'import h5py, xarray, h5netcdf' 2> /dev/null ||
    { echo "no Python with h5py, xarray and h5netcdf"; exit 77; }
refused() { "$@" || echo "exit $?"; }
"$python" - <<'END'
import h5py, numpy as np, xarray as xr
t = np.arange(2000) / 500
x = np.round(np.sin(2 * np.pi * 5 * t), 6)
with h5py.File("run.mat", "w", userblock_size=512) as f:
    f["t"] = t.reshape(1, -1)
    f["x"] = x.reshape(1, -1)
    f["back"] = t[::-1]
    f["daq/ch0/force"] = x
    f["daq/ch0/time"] = 1000 * t
    f["daq/ch0/time"].attrs["units"] = "ms"
    f["daq/ch0/late"] = np.where(t < 1, t, t + 0.1)
for name in "milliseconds", "days":
    when = np.datetime64("2024-03-05T10:12:13") + (t * 1e9).astype("timedelta64[ns]")
    data = xr.DataArray(x, dims="time", coords={"time": when}, attrs={"units": "N"}).to_dataset(name="force")
    data.to_netcdf(name + ".nc", engine="h5netcdf", encoding={"time": {
        "units": name + " since 2024-03-04 00:00:00", "dtype": "f8"}})
END
head_of() { "$@" | head -n 6; }
head_of ss-cat --time /t run.mat:/x
head_of ss-cat --time /daq/ch0/time --from 1 run.mat:/daq/ch0/force
head_of ss-cat --time time run.mat:/daq/ch0/force
head_of ss-cat --time /daq/ch0/late --gaps=split run.mat:/x
head_of ss-cat --time /daq/ch0/late --resample 250 --gaps=split run.mat:/x
head_of ss-cat --time time milliseconds.nc:/force
head_of ss-cat --time time days.nc:/force
echo "-- refused"
for time in /none none /daq /back /daq/ch0/late; do refused ss-cat --time $time run.mat:/x; done
refused ss-cat --time /back --resample 100 run.mat:/x
refused ss-cat run.mat:/x
refused ss-cat --time /t run.mat
echo "-- in every tool"
ss-cat -q --time /t run.mat:/x > run.tsv
for tool in 'ss-noise --rms 1' ss-morlet 'ss-morlet --stream --fmin 20' 'ss-features -q' 'ss-rank -q --as x'; do
    # shellcheck disable=SC2086  # options are a list
    $tool -c x --time /t run.mat:/x > one
    # shellcheck disable=SC2086
    $tool -c x run.tsv > two
    grep -v '^# signal_name' one > one.body
    grep -v '^# signal_name' two > two.body
    cmp one.body two.body && echo "$tool: the same"
done
ss-plot --time /t run.mat:/x > one
ss-plot run.tsv > two
cmp one two && echo "ss-plot: the same"
