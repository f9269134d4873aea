//! Enums whose variants are listed in one place, each with its name or description.

/// Declares an enum with a value for each variant, such as its name, and the list `ALL` of its
/// variants, so that no variant lacks either.
///
/// ```
/// corniche_roads::listed! {
///     /// How a road is crossed.
///     #[derive(Debug, Clone, Copy, PartialEq, Eq)]
///     pub enum Crossing {
///         /// On the road.
///         Zebra = "zebra",
///         /// Above it.
///         Footbridge = "footbridge",
///     }
///
///     /// Returns the name.
///     pub fn name() -> &'static str;
/// }
///
/// assert_eq!(Crossing::ALL, [Crossing::Zebra, Crossing::Footbridge]);
/// assert_eq!(Crossing::Footbridge.name(), "footbridge");
/// ```
#[macro_export]
macro_rules! listed {
    (
        $(#[$about:meta])*
        pub enum $name:ident {
            $($(#[$of_variant:meta])* $variant:ident = $said:expr,)+
        }

        $(#[$of_said:meta])*
        $vis:vis fn $says:ident() -> $type:ty;
    ) => {
        $(#[$about])*
        pub enum $name {
            $($(#[$of_variant])* $variant,)+
        }

        impl $name {
            /// All variants, in the order of their numbers, which are their indices here.
            pub const ALL: [Self; [$(Self::$variant),+].len()] = [$(Self::$variant),+];

            $(#[$of_said])*
            #[must_use]
            $vis const fn $says(self) -> $type {
                match self {
                    $(Self::$variant => $said,)+
                }
            }
        }
    };
}
