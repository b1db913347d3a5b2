"""What PyInstaller has to take along for ``import motionrt``."""  # noqa: N999  # PyInstaller wants this name

from PyInstaller.utils.hooks import collect_data_files, collect_submodules, copy_metadata

datas = [*collect_data_files("motionrt"), *copy_metadata("motionrt")]
hiddenimports = collect_submodules("motionrt", filter=lambda name: not name.startswith("motionrt._pyinstaller"))
