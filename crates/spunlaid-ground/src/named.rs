//! What is declared as a table: enums whose variants have names, and methods that set fields.

/// An enum of plain variants, with the list of `ALL` and the `name` of each.
#[macro_export]
macro_rules! named {
    ($(#[$about:meta])* $vis:vis enum $Enum:ident {
        $($(#[$of_variant:meta])* $Variant:ident = $name:literal,)+
    }) => {
        $(#[$about])*
        $vis enum $Enum {
            $($(#[$of_variant])* $Variant,)+
        }

        #[allow(dead_code)]
        impl $Enum {
            /// All of them, in their order.
            $vis const ALL: [Self; [$($name),+].len()] = [$(Self::$Variant),+];

            /// Its name in files, results and messages.
            $vis const fn name(self) -> &'static str {
                match self {
                    $(Self::$Variant => $name,)+
                }
            }
        }
    };
}

/// Methods that take a value and return it with some fields set: `unit(unit: Unit) { unit }`.
#[macro_export]
macro_rules! setters {
    ($vis:vis fn: $($(#[$about:meta])* $name:ident($($arg:ident: $Arg:ty),*) { $($fields:tt)+ })+) => {
        $($(#[$about])* $vis const fn $name(self, $($arg: $Arg),*) -> Self {
            Self { $($fields)+, ..self }
        })+
    };
    // Of a part: `fn in relations: Relations:`.
    ($vis:vis fn in $part:ident: $Part:ident:
        $($(#[$about:meta])* $name:ident($($arg:ident: $Arg:ty),*) { $($fields:tt)+ })+
    ) => {
        $($(#[$about])* $vis const fn $name(self, $($arg: $Arg),*) -> Self {
            Self { $part: $Part { $($fields)+, ..self.$part }, ..self }
        })+
    };
}
