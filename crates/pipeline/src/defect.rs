/// Bad input that was survived and counted, from whichever crate met it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Defect {
    /// In the extract.
    Osm(corniche_osm::Defect),
}

impl Defect {
    /// What kind of defect it is, in words: the name under which it is counted.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Osm(defect) => defect.reason().to_owned(),
        }
    }
}

impl From<&corniche_osm::Defect> for Defect {
    fn from(defect: &corniche_osm::Defect) -> Self {
        Self::Osm(defect.clone())
    }
}
