//! The classes of a layer: an enum with numbers and names, declared in one list.

/// Declares the classes of a layer in order of their numbers, with their names in tables, styles
/// and packages.
macro_rules! named_classes {
    ($(#[$about:meta])* $class:ident: $($(#[$meaning:meta])* $variant:ident = $name:literal,)+) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $class {
            $($(#[$meaning])* $variant,)+
        }

        impl $class {
            /// The number of classes.
            pub const COUNT: usize = [$($name),+].len();

            /// The names of all classes, in order of their numbers.
            pub const NAMES: [&str; Self::COUNT] = [$($name),+];

            /// All classes, in order of their numbers.
            pub const ALL: [Self; Self::COUNT] = [$(Self::$variant),+];

            /// Returns the class with this number.
            #[must_use]
            pub fn from_number(number: u8) -> Option<Self> {
                Self::ALL.get(usize::from(number)).copied()
            }

            /// Returns the number of the class, from 0.
            #[must_use]
            pub const fn number(self) -> u8 {
                self as u8
            }

            /// Returns the name of the class in tables, settings and styles.
            #[must_use]
            pub const fn name(self) -> &'static str {
                Self::NAMES[self as usize]
            }

            /// Returns the class with this name.
            #[must_use]
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|class| class.name() == name)
            }
        }

        impl std::fmt::Display for $class {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}

pub(crate) use named_classes;
