//! Where a merge writes its package: a file, or an object, which is sent when the package is complete.

use std::{
    env, fs,
    path::{Path, PathBuf},
};

use corniche_objects::{Bucket, ObjectAddress, ObjectError, Upload};
use corniche_spec::{Observer, PlanSettings, hex::hex};
use corniche_store::{Claim, Existing, PARTS_NAME, PLAN_NAME, STORE_NAME, make_own_folder};
use sha2::{Digest as _, Sha256};

use crate::{
    BuildError,
    build::destination::{Destination, claim},
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
    /// Is locked until the package is sent. Its name follows from the address: of two merges of one package at once, one is refused.
    _lock: Claim,
    /// Holds nothing but the file and the lock. Dropped last.
    _folder: EmptyFolder,
}

/// Removes a folder that is empty; one in which another merge is at work stays.
struct EmptyFolder(PathBuf);

impl Drop for EmptyFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir(&self.0);
    }
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
        match bucket.find(&address.key)? {
            Some(_) if existing == Existing::Keep => {
                return Err(BuildError::Exists { path: output.to_path_buf() });
            }
            Some(_) => {}
            // Only a list tells apart a bucket that is missing.
            None => drop(bucket.list(&address.key)?),
        }
        let digest = hex(&Sha256::digest(address.to_string().as_bytes()));
        let tmp = tmp.map_or_else(env::temp_dir, Path::to_path_buf);
        let folder = tmp.join(format!("corniche-{}-package", &digest[..16]));
        if let Err(source) = make_own_folder(&folder) {
            return Err(BuildError::Target { folder: tmp, source });
        }
        let lock = claim(&folder.join("merge"), output, &folder)?;
        let file = folder.join(address.file_name());
        let destination = Destination::of(&file, Existing::Replace)?;
        let object =
            PackageObject { bucket, address, existing, _lock: lock, _folder: EmptyFolder(folder) };
        Ok(Self { destination, object: Some(object) })
    }

    /// Fails if the package would replace one of the inputs, or an object of one of the stores.
    pub(crate) fn refuse_inputs(
        &self,
        settings: &PlanSettings,
        stores: &[PathBuf],
    ) -> Result<(), BuildError> {
        let Some(PackageObject { address: package, .. }) = &self.object else {
            return self.destination.refuse_inputs(settings);
        };
        let name = PathBuf::from(format!("/vsis3/{}/{}", package.bucket, package.key));
        if settings.terrain_files().iter().chain(&settings.osm).any(|input| *input == name) {
            return Err(BuildError::TargetIsInput { path: name });
        }
        for store in stores {
            let Some(address) = crate::objects::address(store)? else { continue };
            let of_store = [PARTS_NAME, PLAN_NAME, STORE_NAME].map(|name| address.beneath(name));
            let is_in =
                |key: &String| package.key == *key || package.key.starts_with(&format!("{key}/"));
            if address.bucket == package.bucket && of_store.iter().any(is_in) {
                return Err(BuildError::TargetIsInput { path: store.clone() });
            }
        }
        Ok(())
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
            existing: *existing,
            should_stop: &|| observer.is_cancelled(),
        });
        // Where it was stopped or refused: the parts are in the stores, and merging them again takes little.
        let is_kept =
            !matches!(sent, Ok(_) | Err(ObjectError::Stopped { .. } | ObjectError::Exists { .. }));
        if is_kept {
            let file = file.display();
            observer.warning(&format!(
                "the package is complete, but was not sent; it is kept as {file}"
            ));
        } else if let Err(error) = fs::remove_file(file) {
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
