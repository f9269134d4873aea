//! The target of a merge: a file, or an object that is uploaded when the package is complete.

use std::{
    env, fs,
    path::{Path, PathBuf},
};

use corniche_objects::{Bucket, ObjectAddress, ObjectError, Upload};
use corniche_spec::{BuildObserver, PlanSettings, hex::hex};
use corniche_store::{Claim, Existing, PARTS_NAME, PLAN_NAME, STORE_NAME, make_own_folder};
use sha2::{Digest as _, Sha256};

use crate::{
    BuildError,
    build::destination::{Destination, claim},
    objects::ObjectAccess,
};

/// The target of a package, checked before any work is done.
pub(crate) struct PackageDestination {
    /// The path at which the file is written.
    pub destination: Destination,
    /// The object to which the file is then uploaded.
    object: Option<PackageObject>,
}

struct PackageObject {
    bucket: Bucket,
    address: ObjectAddress,
    existing: Existing,
    /// Locked until the package is uploaded. Its name follows from the address: of two simultaneous
    /// merges of one package, one is rejected.
    _lock: Claim,
    /// A folder that contains nothing but the file and the lock. Dropped last.
    _folder: EmptyFolder,
}

/// Deletes a folder if it is empty; a folder in use by another merge is kept.
struct EmptyFolder(PathBuf);

impl Drop for EmptyFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir(&self.0);
    }
}

impl PackageDestination {
    /// Fails if no package may be written there, or if the existing one must be kept.
    pub(crate) fn resolve(
        output: &Path,
        existing: Existing,
        tmp: Option<&Path>,
        access: &mut ObjectAccess,
    ) -> Result<Self, BuildError> {
        let Some(address) = crate::objects::address(output)? else {
            let destination = Destination::resolve(output, existing)?;
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
            // Only a list request reveals a missing bucket.
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
        let destination = Destination::resolve(&file, Existing::Replace)?;
        let object =
            PackageObject { bucket, address, existing, _lock: lock, _folder: EmptyFolder(folder) };
        Ok(Self { destination, object: Some(object) })
    }

    /// Fails if the package would overwrite one of the inputs, or an object of one of the stores.
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

    /// Uploads the complete file, if the package belongs in object storage.
    pub(crate) fn send(&self, observer: &dyn BuildObserver) -> Result<(), BuildError> {
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
        // After an interruption or a rejection the file is not kept: the parts are in the stores,
        // and merging them again takes little time.
        let is_kept =
            !matches!(sent, Ok(_) | Err(ObjectError::Stopped { .. } | ObjectError::Exists { .. }));
        if is_kept {
            observer.warning(&format!(
                "the package is complete, but was not uploaded; it is kept as {file:?}"
            ));
        } else if let Err(error) = fs::remove_file(file) {
            observer.warning(&format!("{file:?} was not removed: {error}"));
        }
        match sent {
            Ok(_) => Ok(()),
            Err(ObjectError::Stopped { .. }) => Err(BuildError::Interrupted),
            Err(ObjectError::Exists { name }) => Err(BuildError::Exists { path: name.into() }),
            Err(error) => Err(error.into()),
        }
    }
}
