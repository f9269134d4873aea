//! Where a merge writes its package: a file, or an object, which is sent when the package is complete.

use std::{
    env, fs, io,
    path::{Path, PathBuf},
};

use corniche_objects::{Bucket, Existing as ExistingObject, ObjectAddress, ObjectError, Upload};
use sha2::{Digest as _, Sha256};

use crate::{
    BuildError, Existing, Observer, build::destination::Destination, hex::hex,
    objects::ObjectAccess,
};

/// Where a package goes, looked at before any work is done.
pub(crate) struct PackagePlace {
    /// Where the file is written.
    pub(crate) destination: Destination,
    /// Where it is sent then.
    object: Option<PackageObject>,
}

struct PackageObject {
    bucket: Bucket,
    address: ObjectAddress,
    existing: Existing,
    /// Holds nothing but the file.
    folder: PathBuf,
}

impl PackagePlace {
    /// Fails where no package may be written, or where one is that is to be kept.
    pub(crate) fn of(
        output: &Path,
        existing: Existing,
        tmp: Option<&Path>,
        access: &mut ObjectAccess,
    ) -> Result<Self, BuildError> {
        let Some(address) = crate::objects::address(output)? else {
            let destination = Destination::of(output, existing)?;
            return Ok(Self { destination, object: None });
        };
        if address.key.is_empty() {
            return Err(ObjectError::Address { text: address.to_string() }.into());
        }
        let bucket = access.bucket(&address.bucket)?;
        if bucket.find(&address.key)?.is_some() && existing == Existing::Keep {
            return Err(BuildError::Exists { path: output.to_path_buf() });
        }
        // The name follows from the address: of two merges of one package at once, one is refused.
        let digest = hex(&Sha256::digest(address.to_string().as_bytes()));
        let tmp = tmp.map_or_else(env::temp_dir, Path::to_path_buf);
        let folder = tmp.join(format!("corniche-{}-package", &digest[..16]));
        match fs::create_dir(&folder) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
                return Err(BuildError::Target { folder: tmp, source: error });
            }
            _ => {}
        }
        let file = folder.join(address.file_name());
        let destination = Destination::of(&file, Existing::Replace)?;
        Ok(Self { destination, object: Some(PackageObject { bucket, address, existing, folder }) })
    }

    /// Sends the file that is complete now to where the package belongs.
    pub(crate) fn send(&self, observer: &dyn Observer) -> Result<(), BuildError> {
        let Some(PackageObject { bucket, address, existing, .. }) = &self.object else {
            return Ok(());
        };
        let file = &self.destination.target;
        let sent = bucket.upload(&Upload {
            file,
            key: &address.key,
            existing: match existing {
                Existing::Keep => ExistingObject::Keep,
                Existing::Replace => ExistingObject::Replace,
            },
            should_stop: &|| observer.is_cancelled(),
        });
        // Whatever came of it: the parts are in the stores, and merging them again takes little.
        if let Err(error) = fs::remove_file(file) {
            observer.warning(&format!("{} was not removed: {error}", file.display()));
        }
        match sent {
            Ok(_) => Ok(()),
            Err(ObjectError::Stopped { .. }) => Err(BuildError::Interrupted),
            Err(ObjectError::Exists { name }) => Err(BuildError::Exists { path: name.into() }),
            Err(error) => Err(error.into()),
        }
    }
}

impl Drop for PackageObject {
    fn drop(&mut self) {
        // Another merge may be at work in it, and then it stays.
        let _ = fs::remove_dir(&self.folder);
    }
}
